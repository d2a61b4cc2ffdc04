#pragma once

#include <cstddef>
#include <span>

#include <GLES3/gl31.h>

#include "common/gl/objects/gl_handle.h"

namespace vantage {

inline void delete_buffer(GLuint name) { glDeleteBuffers(1, &name); }

/// A GL buffer object of fixed size (vertices, indices, shader storage, uniforms).
class Buffer {
  public:
    /// Throws Error if memory runs out. `initial` may be null.
    Buffer(std::size_t bytes, GLenum usage, const void* initial = nullptr);

    template <class T>
    static Buffer of(std::span<const T> data, GLenum usage = GL_STATIC_DRAW) {
        return Buffer(data.size_bytes(), usage, data.data());
    }

    void write(std::size_t offset, std::span<const std::byte> data);
    /// Copies the content to `data`. Waits for the GPU.
    void read(std::size_t offset, std::span<std::byte> data) const;
    void bind_storage(int binding) const;
    void bind(GLenum target) const { glBindBuffer(target, handle_.name()); }

    GLuint name() const { return handle_.name(); }
    std::size_t bytes() const { return bytes_; }

  private:
    GlHandle<delete_buffer> handle_;
    std::size_t bytes_;
};

}  // namespace vantage
