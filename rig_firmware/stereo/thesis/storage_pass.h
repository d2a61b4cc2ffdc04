#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/pass_profiler.h"

namespace vantage::thesis {

/// A compute pass that reads and writes storage buffers over a picture of fixed size.
class StoragePass {
  public:
    /// rows_each: what the shader knows as ROWS, the rows that one invocation walks down.
    StoragePass(const ShaderLibrary& library, std::string file, cv::Size size, int rows_each = 1);

    /// The program, in use, its uniform `size` set.
    Program& use();
    /// Covers the picture, `layers` times; what is written is there for the next pass that reads
    /// storage.
    void dispatch(int layers = 1) const;

    cv::Size size() const { return size_; }
    /// Pixels, for the accounting of costs.
    double pixels() const { return static_cast<double>(size_.area()); }

  private:
    Program program_;
    cv::Size size_;
    int rows_each_;
};

/// Bytes in the accounting of a pass.
inline PassCost pass_cost(double bytes, double operations) {
    return {static_cast<std::size_t>(bytes), operations};
}

}  // namespace vantage::thesis
