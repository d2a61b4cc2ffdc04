#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "common/gl/objects/buffer.h"
#include "common/gl/shader_library.h"
#include "common/image/image.h"
#include "common/image/image_file.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"
#include "tests/references/stereo/feature_reference.h"

namespace vantage {

/// A disparity in LeftRightPass's form, one confidence for all; padding may hold anything.
inline Buffer buffer_of(const DisparityImage& disparity, const StereoLayout& layout,
                        std::uint32_t confidence) {
    std::vector<std::uint32_t> words(layout.pixels(), 0xff00ffff);
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x)
            words[static_cast<std::size_t>(y * layout.stride_px() + x)] =
                disparity(y, x) | confidence << 16;
    return Buffer::of<std::uint32_t>(words);
}

/// Every component of a buffer of `channels` words a pixel, without the row padding.
inline cv::Mat1i channel_of(const Buffer& buffer, const StereoLayout& layout, int channels,
                            int channel) {
    std::vector<int> words(buffer.bytes() / 4);
    buffer.read(0, std::as_writable_bytes(std::span(words)));
    cv::Mat1i image(layout.height_px, layout.width_px);
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x)
            image(y, x) =
                words[static_cast<std::size_t>((y * layout.stride_px() + x) * channels + channel)];
    return image;
}

/// Likewise of PermPass's winners, which lie in blocks.
inline cv::Mat1i winners_channel(const Buffer& buffer, const StereoLayout& layout,
                                 std::size_t channel) {
    std::vector<int> words(buffer.bytes() / 4);
    buffer.read(0, std::as_writable_bytes(std::span(words)));
    cv::Mat1i image(layout.height_px, layout.width_px);
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x)
            image(y, x) = words[layout.block_at(x, y) * 2 + channel];
    return image;
}

inline void expect_equal(const cv::Mat1i& a, const cv::Mat1i& b, const char* what) {
    ASSERT_EQ(a.size(), b.size());
    for (int y = 0; y < a.rows; ++y)
        for (int x = 0; x < a.cols; ++x)
            ASSERT_EQ(a(y, x), b(y, x)) << what << " at " << x << ", " << y;
}

inline cv::Mat1i bits_of(const cv::Mat1i& words, int first, int count) {
    cv::Mat1i result(words.size());
    for (int i = 0; i < words.rows * words.cols; ++i)
        result(i) = static_cast<int>(static_cast<unsigned>(words(i)) >> first) & ((1 << count) - 1);
    return result;
}

inline cv::Mat1i upper_half(const cv::Mat1i& words) { return bits_of(words, 16, 16); }

inline cv::Mat1i lower_half(const cv::Mat1i& words) { return bits_of(words, 0, 16); }

inline cv::Mat1i as_int(const cv::Mat& image) {
    cv::Mat1i result;
    image.convertTo(result, CV_32S);
    return result;
}

/// How 16 disparities lie in their 16 bytes: one after the other, or as perm_common.glsl has them.
enum class ByteOrder { plain, of_sums };

inline std::size_t byte_of_disparity(std::size_t d, ByteOrder order) {
    if (order == ByteOrder::plain) return d;
    const std::size_t in_half = d % 8;
    return d / 8 * 8 + in_half / 2 % 2 * 4 + in_half % 2 * 2 + in_half / 4;
}

/// costs: 16 bytes a pixel, pixels in blocks, slab after slab; what lies beyond the last disparity
/// may be anything.
inline void expect_equal_costs(const Buffer& buffer, const StereoLayout& layout,
                               const std::vector<cv::Mat1b>& costs,
                               ByteOrder order = ByteOrder::plain) {
    std::vector<unsigned char> bytes(buffer.bytes());
    buffer.read(0, std::as_writable_bytes(std::span(bytes)));
    for (int y = 0; y < layout.height_px; ++y)
        for (int x = 0; x < layout.width_px; ++x)
            for (std::size_t d = 0; d < costs.size(); ++d)
                ASSERT_EQ(bytes[(d / 16 * layout.block_pixels() + layout.block_at(x, y)) * 16 +
                                byte_of_disparity(d % 16, order)],
                          costs[d](y, x))
                    << "disparity " << d << " at " << x << ", " << y;
}

struct TexturedPair {
    ColourImage left, right;
};

/// Smooth noise seen at a disparity that steps from 3 to 9 px, with sensor noise.
inline TexturedPair textured_pair(int width, int height) {
    cv::RNG random(5);
    cv::Mat3b wide(height, width + 16);
    random.fill(wide, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(wide, wide, {5, 5}, 1.2);
    TexturedPair pair{ColourImage(height, width), ColourImage(height, width)};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto pixel = [&](int at) {
                const cv::Vec3b& c = wide(y, std::clamp(at, 0, wide.cols - 1));
                const int noise = random.uniform(-3, 4);
                return cv::Vec4b(cv::saturate_cast<unsigned char>(c[0] + noise), c[1], c[2], 255);
            };
            pair.left(y, x) = pixel(x);
            pair.right(y, x) = pixel(x + (y > height / 2 ? 9 : 3));
        }
    return pair;
}

struct PassCase {
    int width, height, disparities;
};

class EnginePassTest : public testing::TestWithParam<PassCase> {
  protected:
    EglContext context_;
    ShaderLibrary library_;
    PassProfiler profiler_;
    StereoLayout layout_{GetParam().width, GetParam().height};
    TexturedPair pair_ = textured_pair(GetParam().width, GetParam().height);
    StereoPlanes left_ = planes_of(pair_.left), right_ = planes_of(pair_.right);
};

}  // namespace vantage
