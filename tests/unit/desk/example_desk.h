#pragma once

#include <cmath>

#include "common/gl/texture.h"
#include "host_app/desk/desk_state.h"
#include "host_app/desk/shot_places.h"

namespace vantage {

/// A desk of three rigs in the middle of a show, for tests. Of the context that is current.
class ExampleDesk {
  public:
    ExampleDesk()
        : picture(TextureFormat::rgba8, 320, 180, Filter::linear),
          colour(TextureFormat::rgba8, 160, 120, Filter::linear),
          depth(TextureFormat::rgba8, 160, 120, Filter::linear) {
        // Alpha 0, as where no rig saw the surface: the desk shows the pixel all the same.
        picture.upload(ColourImage(180, 320, cv::Vec4b(40, 90, 140, 0)));
        colour.upload(ColourImage(120, 160, cv::Vec4b(150, 60, 60, 255)));
        depth.upload(ColourImage(120, 160, cv::Vec4b(230, 210, 60, 255)));
        state.picture = &picture;
        state.waiting = false;
        state.recording = true;
        state.timecode = "10:00:07:12";
        state.pulse = 1234567;
        state.picture_rate_hz = 29.97;
        state.latency_ms = 84;
        for (int i = 0; i < 100; ++i)
            state.latencies_ms.push_back(80.0f + static_cast<float>(i % 13));
        state.synthesiser = "mesh";
        state.steps = {{"capture", 2.1, true}, {"match", 18.4, true}, {"decode", 3.2, false}};
        state.rigs = {rig("north", RigState::present), rig("south", RigState::late),
                      rig("east", RigState::disconnected)};
        state.rigs[1].lost_on_the_way = 17;
        state.rigs[2].colour = state.rigs[2].depth = nullptr;
        DeskOutput film, srt, v4l2;
        film.name = "film flight.mkv";
        film.state = "on";
        film.is_on = true;
        film.mbit_s = 6.2;
        srt.name = "srt://0.0.0.0:9000?mode=listener";
        srt.state = "waiting for a caller";
        v4l2.name = "v4l2:/dev/video10";
        v4l2.state = "FAILED";
        v4l2.is_failed = true;
        v4l2.failure = "/dev/video10 cannot be opened: No such file or directory";
        state.outputs = {film, srt, v4l2};
        state.move_progress = 0.4;
        state.coverage = Coverage{.share = 0.97};
        DeskTime time;
        time.oldest = 1000;
        time.newest = 1900;
        state.time = time;
        state.plan = plan();
        state.shots.resize(shot_places);
        state.shots[0] = {"north", &colour, false};
        state.shots[3] = {"kept", &picture, true};
    }

    Texture picture, colour, depth;
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
        rig.nearest_m = 2.1;
        rig.farthest_m = 6.4;
        rig.temperature_c = 61;
        rig.clock = "PTP +120 ns";
        rig.calibration = "12 d, 0.21 px";
        return rig;
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
