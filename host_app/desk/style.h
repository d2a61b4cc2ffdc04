#pragma once

#include <imgui.h>

namespace vantage {

/// The look of the operator's panels: dark, so that the picture is the brightest thing on the desk.
namespace palette {
inline const ImVec4 text{0.88f, 0.90f, 0.93f, 1};
inline const ImVec4 dim{0.55f, 0.59f, 0.65f, 1};
inline const ImVec4 panel{0.063f, 0.075f, 0.094f, 0.90f};
inline const ImVec4 line{0.17f, 0.20f, 0.25f, 1};
inline const ImVec4 accent{0.25f, 0.62f, 0.95f, 1};
inline const ImVec4 good{0.30f, 0.78f, 0.47f, 1};
inline const ImVec4 warn{0.96f, 0.72f, 0.22f, 1};
inline const ImVec4 bad{0.93f, 0.34f, 0.32f, 1};
}  // namespace palette

struct UiFonts {
    ImFont* body = nullptr;
    ImFont* strong = nullptr;
    ImFont* title = nullptr;
};

/// A Dear ImGui context of its own, current while it lives, with the look and the fonts of Vantage.
/// Where DejaVu Sans is not installed, the font that comes with the library takes its place.
class UiContext {
  public:
    /// body_px: height of the body font, 18 for a picture of 1080 rows.
    explicit UiContext(float body_px);
    ~UiContext();
    UiContext(const UiContext&) = delete;
    UiContext& operator=(const UiContext&) = delete;

    const UiFonts& fonts() const { return fonts_; }

  private:
    ImGuiContext* context_;
    UiFonts fonts_;
};

}  // namespace vantage
