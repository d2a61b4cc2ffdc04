#pragma once

#include <GLES3/gl31.h>

#include "common/gl/objects/gl_handle.h"

namespace vantage {

inline void delete_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }

/// A vertex array object. An empty one serves draws whose vertices come from gl_VertexID.
class VertexArray {
  public:
    VertexArray() {
        GLuint name = 0;
        glGenVertexArrays(1, &name);
        handle_ = GlHandle<delete_vertex_array>(name);
    }
    void bind() const { glBindVertexArray(handle_.name()); }

  private:
    GlHandle<delete_vertex_array> handle_;
};

}  // namespace vantage
