#include "common/gl/objects/buffer.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "common/base/error.h"
#include "common/gl/context/limits.h"

namespace vantage {
namespace {

/// The largest buffer that shaders can address. They index buffers with 32-bit signed integers, and
/// a GPU may have a lower limit for storage blocks: 128 MiB on a Raspberry Pi.
std::size_t most_bytes() {
    constexpr std::int64_t most_of_int = (std::int64_t{1} << 31) - 1;
    // llvmpipe reports a limit, but its shaders reach all of the processor's memory.
    if (GlInfo::query().is_software) return most_of_int;
    GLint64 block_bytes = most_of_int;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block_bytes);
    return static_cast<std::size_t>(std::clamp(block_bytes, GLint64{1} << 27, most_of_int));
}

}  // namespace

Buffer::Buffer(std::size_t bytes, GLenum usage, const void* initial) : bytes_(bytes) {
    // OpenGL ES promises 128 MiB, so that the driver is asked for larger ones only.
    constexpr std::size_t promised_bytes = std::size_t{1} << 27;
    if (bytes > promised_bytes && bytes > most_bytes())
        fail(
            "a GPU buffer of {} MB is more than the {} MB that shaders can address on this GPU; "
            "take smaller pictures or a shorter search range",
            bytes >> 20, most_bytes() >> 20);
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
