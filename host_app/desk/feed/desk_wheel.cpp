#include "host_app/desk/feed/desk_wheel.h"

#include <algorithm>
#include <cmath>

#include "host_app/control/hid/jog_mapper.h"

namespace vantage {
namespace {

constexpr int response_samples = 65;
/// Detents that a graph of a wheel without a rest reaches, either way.
constexpr double graph_detents = 5;

DeskWheel::Kind kind_of(JogKind kind) {
    switch (kind) {
        case JogKind::step:
            return DeskWheel::Kind::turns;
        case JogKind::axis:
            return DeskWheel::Kind::axis;
        case JogKind::button:
            break;
    }
    return DeskWheel::Kind::button;
}

/// As JogMapper has it.
double asked_for(const AxisMap& map, bool has_rest, double at) {
    const double gain = map.sensitivity * (map.inverted ? -1 : 1);
    if (!has_rest) return gain * at;
    const double way = response_of(map, at);
    return gain * (map.action == AxisAction::shuttle ? shuttle_speed(way) : way);
}

DeskWheel::Feel feel_of(const WheelMapView& view, const WheelMapView::Control& control) {
    const AxisMap& map = view.feel;
    const bool has_rest = control.control.kind == JogKind::axis;
    DeskWheel::Feel feel;
    feel.steps = map.sensitivity;
    feel.dead_zone = map.dead_zone;
    feel.curve = map.curve;
    feel.inverted = map.inverted;
    feel.to = has_rest ? 1 : graph_detents;
    feel.from = -feel.to;
    feel.unit = !has_rest                           ? "steps"
                : map.action == AxisAction::shuttle ? "x speed"
                                                    : "of full speed";
    for (int i = 0; i < response_samples; ++i)
        feel.response.push_back(static_cast<float>(asked_for(
            map, has_rest, feel.from + i * (feel.to - feel.from) / (response_samples - 1))));
    feel.most = std::abs(asked_for(map, has_rest, feel.to));
    feel.at = has_rest ? control.at : std::clamp(view.turned, feel.from, feel.to);
    feel.asks = asked_for(map, has_rest, has_rest ? control.at : view.turned);
    return feel;
}

}  // namespace

std::optional<DeskWheel> desk_wheel(const std::optional<WheelMapView>& view) {
    if (!view) return std::nullopt;
    DeskWheel wheel;
    wheel.name = view->name;
    wheel.file = view->file;
    wheel.selected = view->selected;
    wheel.is_changed = view->is_changed;
    wheel.remark = view->remark;
    for (const WheelMapView::Control& control : view->controls)
        wheel.controls.push_back({kind_of(control.control.kind), control.control.name, control.does,
                                  control.is_held, control.at});
    if (view->selected < view->controls.size() &&
        view->controls[view->selected].control.kind != JogKind::button)
        wheel.feel = feel_of(*view, view->controls[view->selected]);
    return wheel;
}

}  // namespace vantage
