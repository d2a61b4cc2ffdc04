#pragma once

#include <cmath>

#include "common/gl/objects/texture.h"
#include "host_app/desk/desk_arrangement.h"
#include "host_app/desk/desk_state.h"

namespace vantage {

/// A desk of three rigs during a show, for tests. The textures belong to the current context.
class ExampleDesk {
  public:
    ExampleDesk()
        : picture(TextureFormat::rgba8, 320, 180, Filter::linear),
          colour(TextureFormat::rgba8, 160, 120, Filter::linear),
          depth(TextureFormat::rgba8, 160, 120, Filter::linear),
          mask(TextureFormat::rgba8, 160, 120, Filter::linear),
          preview_picture(TextureFormat::rgba8, 160, 90, Filter::linear) {
        // Alpha 0 means that no rig sees the surface; the desk must show the pixel nevertheless.
        picture.upload(ColourImage(180, 320, cv::Vec4b(40, 90, 140, 0)));
        colour.upload(ColourImage(120, 160, cv::Vec4b(150, 60, 60, 255)));
        preview_picture.upload(ColourImage(90, 160, cv::Vec4b(90, 130, 60, 255)));
        depth.upload(ColourImage(120, 160, cv::Vec4b(230, 210, 60, 255)));
        mask.upload(ColourImage(120, 160, cv::Vec4b(255, 255, 255, 255)));
        state.picture = &picture;
        state.waiting = false;
        state.recording = true;
        state.timecode = "10:00:07:12";
        state.pulse = 1234567;
        state.picture_rate_hz = 29.7;
        state.tick_rate_hz = 29.97;
        state.repeated = 3;
        state.latency_ms = 84;
        for (int i = 0; i < 100; ++i)
            state.latencies_ms.push_back(80.0f + static_cast<float>(i % 13));
        state.synthesiser = "mesh";
        state.steps = {{"capture", 2.1, true}, {"match", 18.4, true}, {"decode", 3.2, false}};
        state.figures = {{"ticks, reprojected, repeated, missed", "5520, 40, 3, 0"},
                         {"between frames", "33 ms, p99 34, max 67"},
                         {"exposure to picture", "82 ms, p99 95, max 130"},
                         {"input to picture", "41 ms, p99 62, max 66"},
                         {"instants, skipped", "5498, 2"},
                         {"rendering, by level", "0: 97 %, 1: 3 %"},
                         {"preparing, by level", "0: 100 %"}};
        state.rigs = {rig("north", RigState::present), rig("south", RigState::late),
                      rig("east", RigState::disconnected)};
        state.rigs[1].lost_on_the_way = 17;
        state.rigs[2].colour = state.rigs[2].depth = state.rigs[2].mask = nullptr;
        DeskOutput film, srt, v4l2;
        film.name = "film flight.mkv";
        film.state = "on";
        film.is_on = true;
        film.mbit_s = 6.2;
        film.queued = 1;
        srt.name = "srt://0.0.0.0:9000?mode=listener";
        srt.state = "waiting for a caller";
        v4l2.name = "v4l2:/dev/video10";
        v4l2.state = "FAILED";
        v4l2.is_failed = true;
        v4l2.failure = "/dev/video10 cannot be opened: No such file or directory";
        state.outputs = {film, srt, v4l2};
        state.move_progress = 0.4;
        state.move = DeskMove{12, {0, 0.25, 0.6, 1}};
        state.coverage = Coverage{.share = 0.97};
        DeskTime time;
        time.oldest = 1000;
        time.newest = 1900;
        state.time = time;
        add_replay();
        state.plan = plan();
        state.shots.resize(shot_places);
        state.shots[0] = {"north", &colour, false};
        state.shots[3] = {"stored", &picture, true};
    }

    /// Adds a camera on preview, to the right of the programme's.
    void show_preview() {
        DeskPreview preview;
        preview.picture = &preview_picture;
        preview.view.azimuth_rad = 0.7;
        preview.picture_rate_hz = 3.4;
        preview.is_near_only = true;
        preview.coverage = Coverage{.share = 0.88};
        state.preview = preview;
    }

    /// Adds points of a wall and a performer.
    void add_points() {
        for (int i = 0; i < 40; ++i)
            for (int j = 0; j < 25; ++j) {
                const float x = 0.1f * static_cast<float>(i - 20), y = 0.1f * static_cast<float>(j);
                state.plan->points.push_back({{x, y, -2.5f}, {90, 110, 150}});
                if (std::abs(i - 20) < 4 && j < 18)
                    state.plan->points.push_back({{x, y, 0.3f}, {220, 150, 60}});
            }
    }

    /// Opens the map of a wheel with five buttons whose ring is turned and selected.
    void open_wheel_map() {
        using Kind = DeskWheel::Kind;
        DeskWheel wheel;
        wheel.name = "Contour ShuttleXpress";
        wheel.file = "/home/anna/.config/vantage/jog/shuttle_xpress.toml";
        wheel.is_changed = true;
        wheel.controls = {
            {Kind::turns, "jog", "wheel", false, 5},  {Kind::axis, "shuttle", "shuttle", true, 0.5},
            {Kind::button, "b1", "shot 1", false, 0}, {Kind::button, "b2", "shot 2", false, 0},
            {Kind::button, "b3", "freeze", true, 1},  {Kind::button, "b4", "mode", false, 0},
            {Kind::button, "b5", "nothing", false, 0}};
        wheel.selected = 1;
        DeskWheel::Feel feel;
        feel.dead_zone = 0.2;
        feel.curve = 2;
        feel.unit = "x speed";
        for (int i = -32; i <= 32; ++i) {
            const float way = std::max(0.0f, (std::abs(static_cast<float>(i)) / 32 - 0.2f) / 0.8f);
            feel.response.push_back(std::copysign(2 * way * way, static_cast<float>(i)));
        }
        feel.most = 2;
        feel.at = 0.5;
        feel.asks = 0.28;
        wheel.feel = feel;
        state.wheel_map = wheel;
    }

    Texture picture, colour, depth, mask, preview_picture;
    DeskState state;

  private:
    DeskRig rig(const char* name, RigState rig_state) const {
        DeskRig rig;
        rig.name = name;
        rig.state = rig_state;
        rig.rate_hz = 30;
        rig.latency_ms = 60;
        rig.colour = &colour;
        rig.depth = &depth;
        rig.mask = &mask;
        rig.nearest_m = 2.1;
        rig.farthest_m = 6.4;
        rig.temperature_c = 61;
        rig.clock = "PTP +120 ns";
        rig.calibration = "12 d, 0.21 px";
        return rig;
    }
    /// Adds clips and a play list at its second entry.
    void add_replay() {
        DeskReplay& replay = state.replay;
        for (int number = 1; number <= 4; ++number) {
            DeskClip clip;
            clip.number = number;
            clip.name = number == 2 ? "the leap" : "10:00:07";
            clip.in = 1000 + 150 * number;
            clip.out = clip.in + 90;
            clip.duration_s = 3;
            clip.speed = number == 2 ? 0.5 : 1;
            clip.is_in_hand = number == 3;
            clip.is_played = number == 2;
            clip.loss = number == 1 ? "PART GONE" : "";
            clip.picture = number < 4 ? &colour : nullptr;
            replay.clips.push_back(clip);
        }
        for (const char* name : {"1  10:00:07:12", "2 the leap  10:00:12:12", "3  10:00:17:12"})
            replay.entries.push_back({.name = name, .duration_s = 3});
        replay.entries[1].is_playing = true;
        replay.entries[1].duration_s = 6;
        replay.entries[1].speed = 0.5;
        replay.entries[2].is_selected = true;
        replay.clip = 2;
        replay.clip_left_s = 4.2;
        replay.list_left_s = 7.2;
    }
    static DeskPlan plan() {
        DeskPlan plan;
        for (const double azimuth : {-0.5, 0.0, 0.5}) {
            const Eigen::Vector3d eye(4 * std::sin(azimuth), 1, 4 * std::cos(azimuth));
            plan.rigs.push_back({azimuth < 0   ? "north"
                                 : azimuth > 0 ? "east"
                                               : "south",
                                 eye, -Eigen::Vector3d(eye.x(), 0, eye.z()).normalized(), 0.4,
                                 false});
        }
        plan.corridor = {{0, 1.6, 2, 5, CorridorPlace::inside},
                         {1.2, 0.8, 2, 5, CorridorPlace::edge}};
        for (int i = 0; i < 20; ++i) plan.path_m.emplace_back(0.1 * i, 1, 4 - 0.02 * i);
        return plan;
    }
};

}  // namespace vantage
