#pragma once

#include <array>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "host_app/replay/transport_input.h"

namespace vantage {
namespace command {

// Executed by FlightController, for the camera that the operator flies.
struct ResetView {};
struct RecallShot {
    int number = 0;  ///< from 1
};
struct StoreShot {
    int number = 0;  ///< from 1
};
struct LookAt {
    Eigen::Vector3d point_m;  ///< the new pivot, in the world
};
struct ToggleHorizon {};
struct NextWheelMode {};
struct ToggleMove {};
struct AddKeyframe {};
struct SetKeyframe {};
struct RemoveKeyframe {};
struct JumpKeyframes {
    int count = 0;  ///< negative: backwards along the move
};

// Executed by FlightControls.
struct TogglePreview {};
struct Cut {};
struct FlyToPreview {};
struct SetFlyDuration {
    double duration_s = 0;  ///< of every flight to the preview from now on
};
struct ToggleTracking {};
struct ToggleFollow {};
struct ToggleRecording {};
struct ToggleJogMap {};

// Executed by the programme.
struct NextSynthesiser {};
struct ToggleSourceMap {};

// Executed by the session, on its own thread.
struct ToggleTake {};
struct SaveBackground {};
struct LearnBackground {};
struct ReloadStage {};
struct ToggleOutput {
    int number = 0;  ///< from 1
};
/// Move the pivot to the surface that is visible at a place in the picture.
struct PickPivot {
    Eigen::Vector2d place;  ///< 0..1 to the right and down
};
struct CueTime {
    std::string time;  ///< see pulse_in_past()
};

}  // namespace command

using FlightCommand = std::variant<command::ResetView, command::RecallShot, command::StoreShot,
                                   command::LookAt, command::ToggleHorizon, command::NextWheelMode,
                                   command::ToggleMove, command::AddKeyframe, command::SetKeyframe,
                                   command::RemoveKeyframe, command::JumpKeyframes>;
using CameraCommand =
    std::variant<command::TogglePreview, command::Cut, command::FlyToPreview,
                 command::SetFlyDuration, command::ToggleTracking, command::ToggleFollow,
                 command::ToggleRecording, command::ToggleJogMap>;
using PictureCommand = std::variant<command::NextSynthesiser, command::ToggleSourceMap>;
using SessionCommand =
    std::variant<command::ToggleTake, command::SaveBackground, command::LearnBackground,
                 command::ReloadStage, command::ToggleOutput, command::PickPivot, command::CueTime>;

/// A command of an operator, grouped by the class that executes it. A new command needs its struct
/// in one of the groups, its row in the table (control/table) and its handler.
using Command = std::variant<FlightCommand, CameraCommand, TransportCommand, ReplayCall,
                             PictureCommand, SessionCommand>;

/// Whether T is one of the alternatives of a variant.
template <class T, class Variant>
inline constexpr bool is_alternative = false;
template <class T, class... Types>
inline constexpr bool is_alternative<T, std::variant<Types...>> = (std::is_same_v<T, Types> || ...);

/// Operator input since the last poll, of all devices together: analogue axes that add up, and
/// commands in the order in which they were given. Angles are in radians, shifts in picture widths,
/// dolly and zoom in powers of e (see OrbitCamera).
struct FlightInput {
    double orbit_azimuth_rad = 0, orbit_elevation_rad = 0;
    double pan_right_widths = 0, pan_up_widths = 0;
    double dolly = 0, zoom = 0;
    double crane_up_widths = 0;
    double look_right_rad = 0, look_up_rad = 0;  ///< the camera turns where it stands
    double roll_rad = 0;
    double retime_s = 0;     ///< shift of the keyframe nearest to the position on the move
    double wheel_steps = 0;  ///< detents of a jog wheel, clockwise positive
    /// Way that a shuttle ring asks for: seconds at normal speed, so twice the elapsed time at 2x.
    double shuttle_s = 0;

    std::vector<Command> commands = {};

    /// The last command of type T, or null.
    template <class T>
    const T* find() const {
        const T* found = nullptr;
        for (const Command& each : commands)
            std::visit(
                [&](const auto& group) {
                    if constexpr (std::is_same_v<T, std::remove_cvref_t<decltype(group)>>)
                        found = &group;
                    else if constexpr (is_alternative<T, std::remove_cvref_t<decltype(group)>>)
                        found = std::holds_alternative<T>(group) ? &std::get<T>(group) : found;
                },
                each);
        return found;
    }
    /// Calls `execute` with each command of a group, in order.
    template <class Group, class Execute>
    void for_each(const Execute& execute) const {
        for (const Command& each : commands)
            if (const Group* group = std::get_if<Group>(&each)) std::visit(execute, *group);
    }

    /// Whether one of the camera's own axes moves.
    bool turns_camera() const;
    /// Whether the operator flies the camera, by its axes or to a view.
    bool steers() const;
    /// Whether the pivot moves to another point of the stage.
    bool moves_pivot() const;
    bool turns_wheel() const { return wheel_steps != 0 || shuttle_s != 0; }
    bool is_any() const;

    /// Adds the axes, and appends the commands.
    void add(const FlightInput& other);
    void add_axes(const FlightInput& other);
};

}  // namespace vantage
