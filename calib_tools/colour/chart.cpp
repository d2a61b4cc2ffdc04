#include "calib_tools/colour/chart.h"

#include <opencv2/imgproc.hpp>
#include <opencv2/mcc.hpp>

namespace vantage {
namespace {

constexpr unsigned char published[24][3] = {
    {115, 82, 68},   {194, 150, 130}, {98, 122, 157}, {87, 108, 67},   {133, 128, 177},
    {103, 189, 170}, {214, 126, 44},  {80, 91, 166},  {193, 90, 99},   {94, 60, 108},
    {157, 188, 64},  {224, 163, 46},  {56, 61, 150},  {70, 148, 73},   {175, 54, 60},
    {231, 199, 31},  {187, 86, 149},  {8, 133, 161},  {243, 243, 242}, {200, 200, 200},
    {160, 160, 160}, {122, 122, 121}, {85, 85, 85},   {52, 52, 52}};

}  // namespace

std::vector<Eigen::Vector3d> chart_colours() {
    std::vector<Eigen::Vector3d> colours;
    for (const auto& c : published) colours.push_back(Eigen::Vector3d(c[0], c[1], c[2]) / 255);
    return colours;
}

std::optional<std::vector<ColourPatch>> find_chart(const ColourImage& picture) {
    cv::Mat bgr;
    cv::cvtColor(picture, bgr, cv::COLOR_RGBA2BGR);
    const cv::Ptr<cv::mcc::CCheckerDetector> detector = cv::mcc::CCheckerDetector::create();
    if (!detector->process(bgr, cv::mcc::MCC24, 1)) return std::nullopt;
    // 72 rows: R, G and B of every patch; column 1 holds the means.
    const cv::Mat charts = detector->getBestColorChecker()->getChartsRGB();
    const std::vector<Eigen::Vector3d> truth = chart_colours();
    if (charts.rows != static_cast<int>(3 * truth.size()) || charts.cols < 2) return std::nullopt;
    cv::Mat1d values;
    charts.convertTo(values, CV_64F);
    std::vector<ColourPatch> patches;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const int row = static_cast<int>(3 * i);
        patches.push_back(
            {Eigen::Vector3d(values(row, 1), values(row + 1, 1), values(row + 2, 1)) / 255,
             truth[i]});
    }
    return patches;
}

}  // namespace vantage
