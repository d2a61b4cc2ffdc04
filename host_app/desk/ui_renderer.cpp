#include "host_app/desk/ui_renderer.h"

#include <algorithm>
#include <cstddef>

namespace vantage {
namespace {

Texture upload_glyphs() {
    unsigned char* coverage = nullptr;
    int width_px = 0, height_px = 0;
    ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&coverage, &width_px, &height_px);
    Texture glyphs(TextureFormat::r8, width_px, height_px, Filter::linear);
    glyphs.upload(cv::Mat(height_px, width_px, CV_8UC1, coverage));
    ImGui::GetIO().Fonts->SetTexID(ui_texture(glyphs));
    return glyphs;
}

/// A buffer that holds at least `bytes`, with room to grow.
void make_room(std::optional<Buffer>& buffer, std::size_t bytes) {
    if (!buffer || buffer->bytes() < bytes)
        buffer.emplace(std::max<std::size_t>(2 * bytes, 1 << 16), GL_STREAM_DRAW);
}

}  // namespace

UiRenderer::UiRenderer(const ShaderLibrary& shaders)
    : program_(Program::render(shaders, "ui.vert", "ui.frag")), glyphs_(upload_glyphs()) {
    GLuint name = 0;
    glGenSamplers(1, &name);
    filtered_ = GlHandle<delete_sampler>(name);
    glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void UiRenderer::upload(const ImDrawList& list) {
    const auto vertices = std::as_bytes(
        std::span(list.VtxBuffer.Data, static_cast<std::size_t>(list.VtxBuffer.Size)));
    const auto indices = std::as_bytes(
        std::span(list.IdxBuffer.Data, static_cast<std::size_t>(list.IdxBuffer.Size)));
    make_room(vertices_, vertices.size());
    make_room(indices_, indices.size());
    vertex_array_.bind();
    vertices_->write(0, vertices);
    indices_->write(0, indices);
    vertices_->bind(GL_ARRAY_BUFFER);
    indices_->bind(GL_ELEMENT_ARRAY_BUFFER);
    const auto attribute = [](GLuint location, GLint size, GLenum type, GLboolean normalised,
                              std::size_t offset) {
        glEnableVertexAttribArray(location);
        glVertexAttribPointer(location, size, type, normalised, sizeof(ImDrawVert),
                              reinterpret_cast<const void*>(offset));
    };
    attribute(0, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, pos));
    attribute(1, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, uv));
    attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(ImDrawVert, col));
}

void UiRenderer::draw(const ImDrawData& data, const Framebuffer& target) {
    target.bind();
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_SCISSOR_TEST);
    glActiveTexture(GL_TEXTURE0);
    glBindSampler(0, filtered_.name());
    program_.use();
    program_.set("image", 0);
    program_.set("px_to_clip", Eigen::Vector2f(2.0f / static_cast<float>(target.size().width),
                                               2.0f / static_cast<float>(target.size().height)));
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        upload(list);
        for (const ImDrawCmd& command : list.CmdBuffer) {
            if (command.UserCallback) continue;
            const auto left = static_cast<int>(std::max(command.ClipRect.x, 0.0f));
            const auto top = static_cast<int>(std::max(command.ClipRect.y, 0.0f));
            const auto right = static_cast<int>(command.ClipRect.z);
            const auto bottom = static_cast<int>(command.ClipRect.w);
            if (right <= left || bottom <= top) continue;
            glScissor(left, top, right - left, bottom - top);
            const auto texture =
                static_cast<GLuint>(reinterpret_cast<std::uintptr_t>(command.GetTexID()));
            glBindTexture(GL_TEXTURE_2D, texture);
            program_.set("is_glyph", texture == glyphs_.name() ? 1 : 0);
            glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount),
                           sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                           reinterpret_cast<const void*>(command.IdxOffset * sizeof(ImDrawIdx)));
        }
    }
    glBindSampler(0, 0);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
}

}  // namespace vantage
