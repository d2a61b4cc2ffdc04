#include <algorithm>

#include <fmt/format.h>

#include "host_app/desk/panels/desk_parts.h"

namespace vantage {
namespace {

/// Draws a cell of a bin: its picture, if there is one, and its name in the lower left corner.
void draw_bin_cell(const Pen& pen, const DeskRect& place, const Texture* picture,
                   const std::string& words, const ImVec4& colour) {
    const float em = pen.em();
    pen.fill(place, palette::panel);
    if (picture)
        pen.image(place.fitted(static_cast<float>(picture->height_px()) /
                               static_cast<float>(picture->width_px())),
                  *picture);
    const DeskRect label{place.left, place.bottom() - 1.2f * em,
                         std::min(pen.width_of(words, true) + 0.5f * em, place.width), 1.2f * em};
    if (picture) pen.fill(label, palette::panel);
    pen.text_until(place.right(), label.left + 0.25f * em, label.top + 0.1f * em, colour, words,
                   true);
}

void draw_clip(const Pen& pen, const DeskRect& place, const DeskClip& clip) {
    const float em = pen.em();
    draw_bin_cell(pen, place, clip.picture, fmt::format("{} {}", clip.number, clip.name),
                  clip.is_in_hand ? palette::text : palette::dim);
    const std::string length =
        clip.speed == 1 ? fmt::format("{:.1f} s", clip.duration_s)
                        : fmt::format("{:.1f} s {:.0f} %", clip.duration_s, 100 * clip.speed);
    const DeskRect head{place.left, place.top, pen.width_of(length) + 0.5f * em, 1.2f * em};
    pen.fill(head, palette::panel);
    pen.text(head.left + 0.25f * em, head.top + 0.1f * em, palette::text, length);
    if (!clip.loss.empty()) {
        // Between the clip's length and its name.
        const DeskRect shown{place.left, head.bottom(), place.width,
                             place.height - head.height - 1.2f * em};
        pen.fill(shown, palette::veil);
        const float width = std::min(pen.width_of(clip.loss, true) + 0.4f * em, place.width);
        const DeskRect box{place.left, head.bottom(), width, 1.2f * em};
        pen.fill(box, palette::warn);
        pen.text_until(box.right(), box.left + 0.2f * em, box.top + 0.1f * em, palette::on_badge,
                       clip.loss, true);
    }
    if (clip.is_in_hand) pen.outline(place, palette::accent, std::max(1.0f, 0.12f * em));
    if (!clip.is_played) return;
    const float side = 1.2f * em;
    const DeskRect corner{place.right() - side, place.top, side, side};
    pen.fill(corner, palette::on_air);
    pen.list().AddTriangleFilled({corner.left + 0.3f * side, corner.top + 0.2f * side},
                                 {corner.left + 0.3f * side, corner.bottom() - 0.2f * side},
                                 {corner.right() - 0.2f * side, corner.top + 0.5f * side},
                                 ImGui::GetColorU32(palette::on_badge));
}

}  // namespace

void draw_clips(const Pen& pen, const DeskRect& rect, const DeskState& state, DeskSpots& spots) {
    if (rect.is_empty()) return;
    const std::vector<DeskClip>& clips = state.replay.clips;
    const float gap = 0.25f * pen.em();
    const float height = rect.height / shot_places - gap;
    constexpr auto places = static_cast<std::size_t>(shot_places);
    // The clip in hand is always visible.
    const auto in_hand = static_cast<std::size_t>(
        std::find_if(clips.begin(), clips.end(),
                     [](const DeskClip& clip) { return clip.is_in_hand; }) -
        clips.begin());
    std::size_t first = 0;
    if (clips.size() > places && in_hand < clips.size())
        first = std::min(in_hand - std::min(in_hand, places / 2), clips.size() - places);
    for (std::size_t i = 0; i < places && first + i < clips.size(); ++i) {
        const DeskRect place{rect.left, rect.top + static_cast<float>(i) * (height + gap),
                             rect.width, height};
        const Clipping clipping(pen, place);
        draw_clip(pen, place, clips[first + i]);
        spots.clips.push_back({place, clips[first + i].number});
    }
}

void draw_shots(const Pen& pen, const DeskRect& rect, const DeskState& state, DeskSpots& spots) {
    if (rect.is_empty()) return;
    const float gap = 0.25f * pen.em();
    const float height = rect.height / shot_places - gap;
    for (int number = 1; number <= shot_places; ++number) {
        const auto at = static_cast<std::size_t>(number - 1);
        const DeskShot shot = at < state.shots.size() ? state.shots[at] : DeskShot{};
        const DeskRect place{rect.left, rect.top + static_cast<float>(at) * (height + gap),
                             rect.width, height};
        const Clipping clipping(pen, place);
        draw_bin_cell(pen, place, shot.picture, fmt::format("{} {}", number, shot.name),
                      shot.is_kept ? palette::text : palette::dim);
        if (shot.is_kept) pen.outline(place, palette::accent);
        if (!shot.name.empty()) spots.shots.push_back({place, number});
    }
}

}  // namespace vantage
