#pragma once

#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <opencv2/core.hpp>

#include "rig_firmware/capture/v4l2/v4l2_device.h"

namespace vantage {

/// A camera whose picture a test chooses: an output node of the kernel's vivid driver, looped to a
/// capture node. Shows one grey picture until destroyed. The capture node then delivers exactly its
/// bytes as GREY.
class VividLoop {
  public:
    /// `picture`: 8-bit grey of a size that the driver has HDMI timings for (such as 640x480).
    VividLoop(const std::filesystem::path& capture, const std::filesystem::path& output,
              const cv::Mat& picture);
    ~VividLoop();
    VividLoop(const VividLoop&) = delete;
    VividLoop& operator=(const VividLoop&) = delete;

  private:
    void show(const cv::Mat& picture);
    void feed(const std::stop_token& stop) const;

    V4l2Device output_;
    std::jthread feeder_;
};

}  // namespace vantage
