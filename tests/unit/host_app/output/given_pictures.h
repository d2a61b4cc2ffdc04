#pragma once

#include <memory>

#include "host_app/output/output.h"

namespace vantage {

/// A picture of one grey, as the programme hands it out.
inline ProgrammePicture given_picture(std::uint64_t tick, int level = 90, int width_px = 64,
                                      int height_px = 48) {
    const auto grey = static_cast<unsigned char>(level);
    ProgrammePicture picture;
    picture.tick = tick;
    picture.picture = ColourImage(height_px, width_px, cv::Vec4b(grey, grey, grey, 255));
    // What is laid over it for people is on no output.
    picture.overlaid = ColourImage(height_px, width_px, cv::Vec4b(255, 0, 0, 255));
    return picture;
}

/// Until the condition holds; false after half a minute.
template <class Condition>
bool wait_for(Condition condition) {
    for (int i = 0; i < 15000; ++i) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
}

}  // namespace vantage
