#pragma once

#include <optional>
#include <span>

#include <imgui.h>

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/texture.h"
#include "common/gl/objects/vertex_array.h"
#include "host_app/desk/desk_arrangement.h"

namespace vantage {

inline void delete_sampler(GLuint name) { glDeleteSamplers(1, &name); }

/// Converts a texture for ImGui::Image. The texture must live until the frame is drawn.
inline ImTextureID ui_texture(const Texture& texture) {
    // ImGui takes names as pointers. NOLINTNEXTLINE(performance-no-int-to-ptr)
    return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture.name()));
}

/// Draws Dear ImGui's output with OpenGL ES 3.1. (The backend in Debian's library needs desktop
/// OpenGL.) Pictures are drawn opaque and with linear filtering.
class UiRenderer {
  public:
    /// Uploads the fonts of the current ImGui context, which must be loaded.
    explicit UiRenderer(const ShaderLibrary& shaders);

    /// Uploads the fonts again after they have changed.
    void take_fonts();

    /// Draws over the target's content.
    void draw(const ImDrawData& data, const Framebuffer& target);
    /// Draws one picture with the same pixels as ImGui::Image, without an ImGui frame.
    void draw_picture(const Texture& picture, const DeskRect& rect, const Framebuffer& target);

  private:
    void begin(const Framebuffer& target);
    void end();
    void upload(std::span<const ImDrawVert> vertices, std::span<const ImDrawIdx> indices);
    void draw_triangles(GLuint texture, std::size_t first, std::size_t count);

    Program program_;
    std::optional<Texture> glyphs_;
    GlHandle<delete_sampler> filtered_;
    VertexArray vertex_array_;
    std::optional<Buffer> vertices_, indices_;
};

}  // namespace vantage
