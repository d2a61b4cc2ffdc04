#include "host_app/gallery/tour_preparer.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

/// Matte value of 255 from which on a pixel is foreground.
constexpr int min_matte = 26;
/// Part of the image below which a connected part is a speck and is ignored.
constexpr double speck = 0.0008;
/// Lowest rows of a part that give its position on the floor.
constexpr int foot_rows = 3;

}  // namespace

std::vector<CutOut> cut_outs(const cv::Mat1b& matte, std::size_t most, cv::Mat1b& labels) {
    const cv::Mat1b hard = matte >= min_matte;
    cv::Mat1i numbers;
    cv::Mat statistics, centroids;
    const int count = cv::connectedComponentsWithStats(hard, numbers, statistics, centroids);
    std::vector<int> parts;
    const auto area = [&](int part) { return statistics.at<int>(part, cv::CC_STAT_AREA); };
    for (int part = 1; part < count; ++part)
        if (area(part) >= speck * static_cast<double>(matte.total())) parts.push_back(part);
    std::stable_sort(parts.begin(), parts.end(), [&](int a, int b) { return area(a) > area(b); });
    if (parts.size() > most) parts.resize(most);
    labels = cv::Mat1b::zeros(matte.size());
    std::vector<CutOut> found;
    for (const int part : parts) {
        const cv::Mat1b own = numbers == part;
        labels.setTo(static_cast<double>(found.size() + 1), own);
        const int bottom = statistics.at<int>(part, cv::CC_STAT_TOP) +
                           statistics.at<int>(part, cv::CC_STAT_HEIGHT);
        const cv::Moments foot =
            cv::moments(own.rowRange(std::max(0, bottom - foot_rows), bottom), true);
        found.push_back({{foot.m10 / foot.m00, bottom - 1.0}, area(part)});
    }
    return found;
}

void TourPreparer::take(std::span<const DepthView> views, double dt_s) {
    performers_.take(views, dt_s);
    instant_.reset();
}

std::shared_ptr<const Instant> TourPreparer::prepare(const VirtualView& target,
                                                     const PrepareLevel& level) {
    if (instant_) return instant_;
    auto tour = std::make_shared<TourInstant>();
    tour->performers = performers_.prepare(target, level);
    if (const auto* told = dynamic_cast<const ForegroundInstant*>(tour->performers->extra.get()))
        for (const ForegroundInstant::Rig& rig : told->rigs) {
            const cv::Mat1b matte = rig.matte->share.texture().download();
            const std::shared_ptr<TourInstant::Labels> labels = labels_.take();
            if (!labels->numbers || labels->numbers->size() != matte.size())
                labels->numbers.emplace(TextureFormat::r8, matte.cols, matte.rows);
            cv::Mat1b numbers;
            std::vector<CutOut> parts = cut_outs(matte, most_cut_outs, numbers);
            labels->numbers->upload(numbers);
            tour->rigs.push_back({std::move(parts), labels});
        }
    auto instant = std::make_shared<Instant>(*tour->performers);
    instant->extra = std::move(tour);
    instant_ = std::move(instant);
    return instant_;
}

}  // namespace vantage
