#pragma once

#include <optional>
#include <span>

#include <imgui.h>

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/texture.h"
#include "common/gl/objects/vertex_array.h"
#include "host_app/desk/desk_layout.h"

namespace vantage {

inline void delete_sampler(GLuint name) { glDeleteSamplers(1, &name); }

/// How a picture is named to ImGui::Image: the texture must live until the frame is drawn.
inline ImTextureID ui_texture(const Texture& texture) {
    // ImGui takes names as pointers. NOLINTNEXTLINE(performance-no-int-to-ptr)
    return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture.name()));
}

/// Draws Dear ImGui with OpenGL ES 3.1. (The backend that comes with the library as Debian builds
/// it looks for desktop OpenGL.) Pictures are drawn opaque and filtered.
class UiRenderer {
  public:
    /// Takes the fonts of the current ImGui context to the GPU; they must be loaded by then.
    explicit UiRenderer(const ShaderLibrary& shaders);

    /// After the fonts have changed.
    void take_fonts();

    /// Draws over what the target shows.
    void draw(const ImDrawData& data, const Framebuffer& target);
    /// The same pixels as an image of Dear ImGui's there gives, without laying out a frame.
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
