#include "tests/bench/synthesis/truth_regions.h"

#include <chrono>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr int band_px = 5, beside_px = 12, thin_px = 7;
constexpr float one_surface = 0.97f;  ///< of a depth: what is nearer is another thing

cv::Mat square_of(int side_px) { return cv::Mat1b::ones(side_px, side_px); }

}  // namespace

const char* words_of(TruthRegion region) {
    switch (region) {
        case TruthRegion::performers:
            return "performers";
        case TruthRegion::edges:
            return "edges";
        case TruthRegion::beside:
            return "beside";
        case TruthRegion::thin:
            return "thin";
        case TruthRegion::rims:
            return "rims";
        case TruthRegion::surfaces:
            return "surfaces";
    }
    return "";
}

TruthRegion parse_truth_region(const std::string& text) {
    std::string all;
    for (const TruthRegion region : all_truth_regions) {
        if (text == words_of(region)) return region;
        all += std::string(all.empty() ? "" : ", ") + words_of(region);
    }
    fail("there is no region '{}'; there are {}", text, all);
}

cv::Mat1b band_of(const cv::Mat1b& mask, int width_px) {
    cv::Mat1b wide, narrow;
    cv::dilate(mask, wide, square_of(width_px));
    cv::erode(mask, narrow, square_of(width_px));
    return wide & ~narrow;
}

TruthRegions::TruthRegions(VirtualStage& stage, const StageCamera& camera) {
    for (int ms = 0; ms < 24000; ms += 1500) {
        const DepthImage depth_m =
            stage.render(camera, std::chrono::milliseconds(ms), {.pictures = StagePictures::depth})
                .depth_m;
        if (background_depth_m_.empty())
            background_depth_m_ = depth_m;
        else
            background_depth_m_ =
                DepthImage(cv::max(cv::Mat(background_depth_m_), cv::Mat(depth_m)));
    }
    cv::Mat far, near, opened;
    cv::dilate(background_depth_m_, far, square_of(3));
    cv::erode(background_depth_m_, near, square_of(3));
    cv::dilate(cv::Mat1b(near < one_surface * far), rims_, square_of(3));
    // Of depth a closing takes away what an opening of nearness does.
    cv::morphologyEx(background_depth_m_, opened, cv::MORPH_CLOSE, square_of(thin_px));
    cv::dilate(cv::Mat1b(background_depth_m_ < one_surface * opened), thin_, square_of(3));
}

cv::Mat1b TruthRegions::performers(const DepthImage& depth_m) const {
    return depth_m < one_surface * background_depth_m_;
}

cv::Mat1b TruthRegions::of(const DepthImage& depth_m) const {
    const cv::Mat1b inside = performers(depth_m);
    cv::Mat1b around;
    cv::dilate(inside, around, square_of(2 * beside_px + 1));
    cv::Mat1b regions(depth_m.size(), static_cast<uchar>(TruthRegion::surfaces));
    const auto set = [&](TruthRegion region, const cv::Mat1b& where) {
        regions.setTo(static_cast<uchar>(region), where);
    };
    set(TruthRegion::rims, rims_);
    set(TruthRegion::thin, thin_);
    set(TruthRegion::beside, around);
    set(TruthRegion::performers, inside);
    set(TruthRegion::edges, band_of(inside, band_px));
    return regions;
}

}  // namespace vantage
