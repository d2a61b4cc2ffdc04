#pragma once

#include <utility>

#include <GLES3/gl31.h>

namespace vantage {

/// To be called before a GL object is deleted: warns, once a program, if no context is current,
/// since the object then stays in the driver for ever.
void expect_current_context();

/// Owns one GL object name and deletes it with Delete. Move-only. A context of its sharing group
/// must be current at destruction, or CurrentContext::None if the GPU lost it.
template <auto Delete>
class GlHandle {
  public:
    GlHandle() = default;
    explicit GlHandle(GLuint name) : name_(name) {}
    GlHandle(GlHandle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlHandle& operator=(GlHandle&& other) noexcept {
        if (this != &other) {
            reset();
            name_ = std::exchange(other.name_, 0);
        }
        return *this;
    }
    ~GlHandle() { reset(); }

    GLuint name() const { return name_; }

  private:
    void reset() {
        if (name_ == 0) return;
        expect_current_context();
        Delete(name_);
        name_ = 0;
    }
    GLuint name_ = 0;
};

}  // namespace vantage
