#include "host_app/synthesis/source_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

#include "common/base/error.h"

namespace vantage {
namespace {

Eigen::Vector3f as_float(cv::Vec3b colour) {
    return Eigen::Vector3f(colour[0], colour[1], colour[2]) / 255.0f;
}

/// Returns a saturated colour of this hue, 0..1.
cv::Vec3b of_hue(double hue) {
    const auto channel = [&](double offset) {
        const double k = std::fmod(offset + 6 * hue, 6.0);
        return cv::saturate_cast<uchar>(255 * (1 - 0.8 * std::clamp(std::min(k, 4 - k), 0.0, 1.0)));
    };
    return {channel(5), channel(3), channel(1)};
}

}  // namespace

cv::Vec3b source_colour(std::size_t rig) {
    // The palette for colour-blind readers (Okabe and Ito, 2008), with grey instead of black.
    constexpr unsigned char palette[][3] = {{230, 159, 0},   {86, 180, 233}, {0, 158, 115},
                                            {240, 228, 66},  {0, 114, 178},  {213, 94, 0},
                                            {204, 121, 167}, {200, 200, 200}};
    if (rig < std::size(palette)) return {palette[rig][0], palette[rig][1], palette[rig][2]};
    constexpr double golden_turn = 0.618034;
    return of_hue(std::fmod(golden_turn * static_cast<double>(rig), 1.0));
}

nlohmann::ordered_json to_json(const SourceShares& shares) {
    return {{"rigs", shares.rigs}, {"filled", shares.filled}, {"remembered", shares.remembered}};
}

SourceShares source_shares(const ColourImage& picture, const PixelOrigins& origins) {
    const ColourImage shares = origins.shares->download();
    assert(shares.size() == picture.size());
    cv::Vec4d sum(0, 0, 0, 0);
    SourceShares result;
    for (const std::string& rig : origins.rigs) result.rigs[rig] = 0;
    const auto pixels = static_cast<double>(picture.total());
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            const cv::Vec4b& share = shares(y, x);
            const double all = share[0] + share[1] + share[2] + share[3];
            if (picture(y, x)[3] == remembered_alpha) {
                result.remembered += 1 / pixels;
                continue;
            }
            if (picture(y, x)[3] < 128 || all == 0) {
                result.filled += 1 / pixels;
                continue;
            }
            sum += cv::Vec4d(share) / (all * pixels);
        }
    for (std::size_t i = 0; i < origins.rigs.size(); ++i)
        result.rigs[origins.rigs[i]] += sum[static_cast<int>(i)];
    return result;
}

void SourceMapOverlay::require(bool can_tell, const std::string& name) {
    if (!can_tell)
        fail(
            "the synthesiser '{}' does not report which rig a pixel comes from, so that there is "
            "no "
            "source map with it: choose {}",
            name, default_synthesiser);
}

void SourceMapOverlay::name_rigs(const std::vector<std::string>& rigs) {
    for (const std::string& rig : rigs) colour_of(rig);
}

cv::Vec3b SourceMapOverlay::colour_of(const std::string& rig) {
    const auto known = std::find_if(legend_.begin(), legend_.end(),
                                    [&](const Key& key) { return key.rig == rig; });
    if (known != legend_.end()) return known->colour;
    return legend_.emplace_back(Key{rig, source_colour(legend_.size())}).colour;
}

const Texture& SourceMapOverlay::lay(const Texture& picture, const PixelOrigins& origins) {
    assert(origins.rigs.size() <= PixelOrigins::max_rigs);
    // Before anything is bound: making a texture binds it.
    overlaid_.resize(picture.size());
    Program& program = pass_.use();
    program.input("picture", picture);
    program.input("shares", *origins.shares);
    for (std::size_t i = 0; i < origins.rigs.size(); ++i)
        program.set("rig_colour", i, as_float(colour_of(origins.rigs[i])));
    program.set("filled_colour",
                as_float({source_map_inpainted_colour[0], source_map_inpainted_colour[1],
                          source_map_inpainted_colour[2]}));
    program.set("remembered_colour",
                as_float({source_map_remembered_colour[0], source_map_remembered_colour[1],
                          source_map_remembered_colour[2]}));
    program.set("remembered_alpha", remembered_alpha / 255.0f);
    pass_.draw(overlaid_.target());
    return overlaid_.texture();
}

}  // namespace vantage
