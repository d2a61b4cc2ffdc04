#include "rig_firmware/stereo/features/reduce_pass.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

namespace vantage {
namespace {

/// Returns the ratio of two sizes, width and height.
Eigen::Vector2f ratio(cv::Size from, cv::Size to) {
    return {static_cast<float>(from.width) / static_cast<float>(to.width),
            static_cast<float>(from.height) / static_cast<float>(to.height)};
}

/// Returns the samples a side: one bilinear sample covers two pixels.
int taps(cv::Size from, cv::Size to) {
    return static_cast<int>(std::ceil(0.5f * ratio(from, to).maxCoeff()));
}

}  // namespace

cv::Size reduced_size(cv::Size picture, int width_px) {
    if (width_px == 0) return picture;
    const double height_px = static_cast<double>(picture.height) * width_px / picture.width;
    return {width_px, std::max(1, static_cast<int>(std::lround(height_px)))};
}

ReducePass::ReducePass(const ShaderLibrary& library, cv::Size from, cv::Size to)
    : from_(from),
      reduced_(TextureFormat::rgba8, to.width, to.height),
      target_({&reduced_}),
      pass_(library, "picture_reduce.frag", {{"TAPS", std::to_string(taps(from, to))}}) {
    assert(to.width <= from.width && to.height <= from.height);
}

const Texture& ReducePass::reduce(const Texture& picture) {
    assert(picture.size() == from_);
    Program& program = pass_.use();
    program.input("picture", picture);
    program.set("px_per_px", ratio(from_, reduced_.size()));
    pass_.overwrite(target_);
    return reduced_;
}

PassCost ReducePass::cost() const {
    constexpr std::size_t bytes_per_pixel = 4;
    // Instructions for a pixel, and for each sample of it.
    constexpr double of_pixel = 13, of_sample = 6;
    const auto pixels = static_cast<std::size_t>(reduced_.size().area());
    const int side = taps(from_, reduced_.size());
    return {.bytes_moved = (static_cast<std::size_t>(from_.area()) + pixels) * bytes_per_pixel,
            .operations = static_cast<double>(pixels) * (of_pixel + of_sample * side * side)};
}

std::size_t ReducePass::gpu_bytes() const {
    return static_cast<std::size_t>(reduced_.size().area()) * 4;
}

}  // namespace vantage
