#include "tests/support/wire_frames.h"

#include <opencv2/core.hpp>

#include "common/geometry/pose.h"

namespace vantage {

RigFrame make_frame(std::uint64_t trigger_index, int width_px, int height_px) {
    RigFrame frame;
    frame.rig = "rig-a";
    frame.session = 77;
    frame.synchronized = true;
    frame.trigger_index = trigger_index;
    frame.exposure = TaiClock::now();
    frame.calibration_id = "bench-7";
    frame.geometry = {width_px, height_px, 300.5, 30.25, 31.5, 22.75, 0.12};
    frame.world_from_camera = look_at({1, 2, 3}, {0, 1, 0});
    frame.max_disparity_px = 64;
    frame.times = {1.5f, 2.5f, 3.5f, 0};
    frame.counters = {100, 2, 3, 0, 0};
    frame.sync = {.role = RigSync::Role::lead,
                  .ready = true,
                  .first_pulse = 40,
                  .pulses = 98,
                  .skipped = 2,
                  .unsynchronized = 1,
                  .lateness_p50_us = 20.5f,
                  .lateness_p99_us = 60.25f,
                  .lateness_max_us = 99.5f,
                  .clock_ppm = -3.5,
                  .clock_steps = 1,
                  .disciplined = true,
                  .ptp_offset_ns = -150.5,
                  .ptp_path_delay_ns = 1000,
                  .ptp_state = "SLAVE",
                  .tai_offset_s = -37};
    cv::RNG random(trigger_index + 1);
    frame.colour.create(height_px, width_px);
    frame.disparity.create(height_px, width_px);
    for (int y = 0; y < height_px; ++y)
        for (int x = 0; x < width_px; ++x) {
            frame.colour(y, x) =
                cv::Vec4b(static_cast<std::uint8_t>(3 * x), static_cast<std::uint8_t>(5 * y),
                          static_cast<std::uint8_t>(random.uniform(0, 256)), 255);
            frame.disparity(y, x) =
                random.uniform(0, 10) == 0
                    ? 0
                    : static_cast<std::uint16_t>(320 + 2 * x + y + random.uniform(0, 3));
        }
    return frame;
}

bool same_pixels(const cv::Mat& a, const cv::Mat& b) {
    return a.size() == b.size() && a.type() == b.type() &&
           (a.empty() || cv::norm(a, b, cv::NORM_INF) == 0);
}

}  // namespace vantage
