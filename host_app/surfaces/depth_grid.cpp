#include "host_app/surfaces/depth_grid.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace vantage {

int triangle_indices(cv::Size depth_size) {
    return 6 * (depth_size.width - 1) * (depth_size.height - 1);
}

IndirectTriangles::IndirectTriangles(int max_indices)
    : indices(static_cast<std::size_t>(std::max(max_indices, 1)) * sizeof(std::uint32_t),
              GL_DYNAMIC_DRAW),
      command(5 * sizeof(std::uint32_t), GL_DYNAMIC_DRAW),
      capacity(max_indices) {}

void IndirectTriangles::begin() const {
    const std::array<std::uint32_t, 5> none = {0, 1, 0, 0, 0};
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, command.name());
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof(none), none.data());
    indices.bind_storage(0);
    command.bind_storage(1);
}

void IndirectTriangles::draw() const {
    indices.bind(GL_ELEMENT_ARRAY_BUFFER);
    command.bind(GL_DRAW_INDIRECT_BUFFER);
    glDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr);
}

}  // namespace vantage
