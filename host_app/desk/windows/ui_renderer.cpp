#include "host_app/desk/windows/ui_renderer.h"

#include <algorithm>
#include <array>
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

/// Replaces a buffer that is smaller than `bytes` by one of twice the size.
void make_room(std::optional<Buffer>& buffer, std::size_t bytes) {
    if (!buffer || buffer->bytes() < bytes)
        buffer.emplace(std::max<std::size_t>(2 * bytes, 1 << 16), GL_STREAM_DRAW);
}

}  // namespace

UiRenderer::UiRenderer(const ShaderLibrary& shaders)
    : program_(Program::render(shaders, "ui.vert", "ui.frag")) {
    take_fonts();
    GLuint name = 0;
    glGenSamplers(1, &name);
    filtered_ = GlHandle<delete_sampler>(name);
    glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void UiRenderer::take_fonts() { glyphs_.emplace(upload_glyphs()); }

void UiRenderer::upload(std::span<const ImDrawVert> vertices, std::span<const ImDrawIdx> indices) {
    make_room(vertices_, vertices.size_bytes());
    make_room(indices_, indices.size_bytes());
    vertex_array_.bind();
    vertices_->write(0, std::as_bytes(vertices));
    indices_->write(0, std::as_bytes(indices));
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

void UiRenderer::begin(const Framebuffer& target) {
    target.bind();
    glBlendEquation(GL_FUNC_ADD);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glActiveTexture(GL_TEXTURE0);
    glBindSampler(0, filtered_.name());
    program_.use();
    program_.set("image", 0);
    program_.set("px_to_clip", Eigen::Vector2f(2.0f / static_cast<float>(target.size().width),
                                               2.0f / static_cast<float>(target.size().height)));
}

void UiRenderer::end() {
    glBindSampler(0, 0);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
}

void UiRenderer::draw_triangles(GLuint texture, std::size_t first, std::size_t count) {
    glBindTexture(GL_TEXTURE_2D, texture);
    program_.set("is_glyph", texture == glyphs_->name() ? 1 : 0);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count),
                   sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(first * sizeof(ImDrawIdx)));
}

void UiRenderer::draw(const ImDrawData& data, const Framebuffer& target) {
    begin(target);
    glEnable(GL_BLEND);
    glEnable(GL_SCISSOR_TEST);
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        upload({list.VtxBuffer.Data, static_cast<std::size_t>(list.VtxBuffer.Size)},
               {list.IdxBuffer.Data, static_cast<std::size_t>(list.IdxBuffer.Size)});
        for (const ImDrawCmd& command : list.CmdBuffer) {
            if (command.UserCallback) continue;
            const auto left = static_cast<int>(std::max(command.ClipRect.x, 0.0f));
            const auto top = static_cast<int>(std::max(command.ClipRect.y, 0.0f));
            const auto right = static_cast<int>(command.ClipRect.z);
            const auto bottom = static_cast<int>(command.ClipRect.w);
            if (right <= left || bottom <= top) continue;
            glScissor(left, top, right - left, bottom - top);
            draw_triangles(
                static_cast<GLuint>(reinterpret_cast<std::uintptr_t>(command.GetTexID())),
                command.IdxOffset, command.ElemCount);
        }
    }
    end();
}

void UiRenderer::draw_picture(const Texture& picture, const DeskRect& rect,
                              const Framebuffer& target) {
    begin(target);
    const auto corner = [](float x, float y, float u, float v) {
        return ImDrawVert{{x, y}, {u, v}, IM_COL32_WHITE};
    };
    const std::array vertices{
        corner(rect.left, rect.top, 0, 0), corner(rect.right(), rect.top, 1, 0),
        corner(rect.right(), rect.bottom(), 1, 1), corner(rect.left, rect.bottom(), 0, 1)};
    constexpr std::array<ImDrawIdx, 6> indices{0, 1, 2, 0, 2, 3};
    upload(vertices, indices);
    draw_triangles(picture.name(), 0, indices.size());
    end();
}

}  // namespace vantage
