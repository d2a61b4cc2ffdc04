#include "common/gl/objects/buffer.h"

#include <cassert>
#include <cstring>

#include "common/base/error.h"
#include "common/gl/context/limits.h"

namespace vantage {
namespace {

/// Shaders index buffers with 32-bit signed integers.
constexpr std::size_t most_bytes = (std::size_t{1} << 31) - 1;

}  // namespace

Buffer::Buffer(std::size_t bytes, GLenum usage, const void* initial) : bytes_(bytes) {
    if (bytes > most_bytes)
        fail(
            "a GPU buffer of {} MB is more than the {} MB that shaders can address; take smaller "
            "pictures or a shorter search range",
            bytes >> 20, most_bytes >> 20);
    GLuint name = 0;
    glGenBuffers(1, &name);
    handle_ = GlHandle<delete_buffer>(name);
    // COPY_WRITE is a binding point that no vertex array or shader uses.
    glBindBuffer(GL_COPY_WRITE_BUFFER, name);
    glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes), initial, usage);
    check_gl("allocating a buffer");
}

void Buffer::write(std::size_t offset, std::span<const std::byte> data) {
    assert(offset + data.size() <= bytes_);
    glBindBuffer(GL_COPY_WRITE_BUFFER, handle_.name());
    glBufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offset),
                    static_cast<GLsizeiptr>(data.size()), data.data());
}

void Buffer::read(std::size_t offset, std::span<std::byte> data) const {
    assert(offset + data.size() <= bytes_);
    if (data.empty()) return;
    glBindBuffer(GL_COPY_READ_BUFFER, handle_.name());
    const void* mapped = glMapBufferRange(GL_COPY_READ_BUFFER, static_cast<GLintptr>(offset),
                                          static_cast<GLsizeiptr>(data.size()), GL_MAP_READ_BIT);
    if (!mapped) fail("a GPU buffer of {} bytes could not be mapped for reading", bytes_);
    std::memcpy(data.data(), mapped, data.size());
    glUnmapBuffer(GL_COPY_READ_BUFFER);
}

void Buffer::bind_storage(int binding) const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(binding), handle_.name());
}

}  // namespace vantage
