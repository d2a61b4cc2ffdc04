#pragma once

#include <cstring>

#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "common/gl/objects/buffer.h"
#include "common/gl/shader_library.h"
#include "common/image/image.h"
#include "rig_firmware/stereo/thesis/cost_volume.h"

// Pictures and cost volumes to and from the storage buffers of the thesis' passes.
namespace vantage::thesis {

struct PictureCase {
    int width_px, height_px, disparities;
};

inline void PrintTo(const PictureCase& c, std::ostream* out) {
    *out << c.width_px << "x" << c.height_px << "x" << c.disparities;
}

/// Odd sizes, a picture smaller than a workgroup, and searches that do not fill their last slice.
inline const PictureCase picture_cases[] = {
    {61, 47, 13}, {61, 47, 32}, {7, 5, 9}, {1, 3, 2}, {311, 239, 21}};

/// Soft blobs with noise on top: neighbouring colours that are alike, others that are not.
inline ColourImage blobs(int width_px, int height_px, std::uint64_t seed) {
    cv::RNG random(seed);
    cv::Mat4b coarse(height_px / 6 + 2, width_px / 6 + 2);
    random.fill(coarse, cv::RNG::UNIFORM, 0, 256);
    ColourImage picture;
    cv::resize(coarse, picture, {width_px, height_px}, 0, 0, cv::INTER_CUBIC);
    cv::Mat4b noise(picture.size());
    random.fill(noise, cv::RNG::UNIFORM, 0, 12);
    picture += noise;
    for (cv::Vec4b& c : picture) c[3] = 255;
    return picture;
}

inline CostVolume random_volume(const PictureCase& size, std::uint64_t seed) {
    CostVolume volume(size.width_px, size.height_px, size.disparities);
    cv::RNG random(seed);
    for (std::uint16_t& cost : volume.costs)
        cost = static_cast<std::uint16_t>(random.uniform(0, max_cost + 1));
    return volume;
}

inline Buffer empty_words(cv::Size size) {
    return Buffer(static_cast<std::size_t>(size.area()) * 4, GL_DYNAMIC_COPY);
}

inline Buffer to_buffer(const ColourImage& picture) {
    return Buffer(picture.total() * 4, GL_DYNAMIC_COPY, picture.data);
}

inline Buffer to_buffer(const cv::Mat1b& codes) {
    cv::Mat1i words;
    codes.convertTo(words, CV_32S);
    return Buffer(words.total() * 4, GL_DYNAMIC_COPY, words.data);
}

inline ColourImage picture_in(const Buffer& buffer, cv::Size size) {
    ColourImage picture(size);
    buffer.read(0, {reinterpret_cast<std::byte*>(picture.data), picture.total() * 4});
    return picture;
}

/// The lowest byte of every word.
inline cv::Mat1b codes_in(const Buffer& buffer, cv::Size size) {
    cv::Mat1b codes;
    cv::extractChannel(picture_in(buffer, size), codes, 0);
    return codes;
}

inline std::size_t half_index(const CostVolume& volume, int d, int y, int x) {
    const auto pixels = static_cast<std::size_t>(volume.width_px * volume.height_px);
    const auto pixel = static_cast<std::size_t>(y * volume.width_px + x);
    const auto slice = static_cast<std::size_t>(d / disparities_per_slice);
    return (slice * pixels + pixel) * disparities_per_slice +
           static_cast<std::size_t>(d % disparities_per_slice);
}

/// Padding costs the most, as HypothesesPass leaves it.
inline Buffer to_buffer(const CostVolume& volume) {
    const auto elements = static_cast<std::size_t>(volume.width_px * volume.height_px *
                                                   slices_for(volume.disparities));
    std::vector<std::uint16_t> halves(elements * disparities_per_slice, max_cost);
    for (int d = 0; d < volume.disparities; ++d)
        for (int y = 0; y < volume.height_px; ++y)
            for (int x = 0; x < volume.width_px; ++x)
                halves[half_index(volume, d, y, x)] = volume.at(d, y, x);
    return Buffer(halves.size() * 2, GL_DYNAMIC_COPY, halves.data());
}

inline CostVolume volume_in(const Buffer& buffer, const PictureCase& size) {
    CostVolume volume(size.width_px, size.height_px, size.disparities);
    std::vector<std::uint16_t> halves(buffer.bytes() / 2);
    buffer.read(0, std::as_writable_bytes(std::span(halves)));
    for (int d = 0; d < volume.disparities; ++d)
        for (int y = 0; y < volume.height_px; ++y)
            for (int x = 0; x < volume.width_px; ++x)
                volume.at(d, y, x) = halves[half_index(volume, d, y, x)];
    return volume;
}

}  // namespace vantage::thesis
