#include "host_app/pipeline/rig_demand.h"

#include <array>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "common/geometry/pose.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// A rig that stands around the origin, 4 m away, and sees a wall at its distance.
DepthView rig_at(double azimuth_deg) {
    const double azimuth_rad = azimuth_deg * std::numbers::pi / 180;
    DepthView view;
    view.name = std::to_string(static_cast<int>(azimuth_deg));
    view.K << 50, 0, 29.5, 0, 50, 19.5, 0, 0, 1;
    view.world_from_camera =
        look_at({4 * std::sin(azimuth_rad), 0, 4 * std::cos(azimuth_rad)}, {0, 0, 0}, {0, 1, 0});
    view.colour.create(40, 60);
    view.depth_m = DepthImage(40, 60, 4.0f);
    return view;
}

VirtualView view_at(double azimuth_deg) {
    const DepthView rig = rig_at(azimuth_deg);
    return {60, 40, rig.K, rig.world_from_camera};
}

class RigDemandTest : public testing::Test {
  protected:
    RigDemandTest() {
        for (double azimuth_deg = -80; azimuth_deg <= 80; azimuth_deg += 20)
            rigs_.push_back(rig_at(azimuth_deg));
        demand_.see(rigs_);
    }

    std::map<std::string, bool> update(double azimuth_deg, std::chrono::nanoseconds after) {
        std::map<std::string, bool> changes;
        for (const auto& change : demand_.update(std::array{view_at(azimuth_deg)}, start_ + after))
            changes[change.rig] = change.streaming;
        return changes;
    }

    std::vector<DepthView> rigs_;
    RigDemand demand_;
    const MonotonicTime start_ = MonotonicTime{} + 100s;
};

TEST_F(RigDemandTest, ReleasesFarRigsAfterAWhileAndKeepsNearOnes) {
    EXPECT_TRUE(update(0, 0s).empty());
    EXPECT_TRUE(update(0, 2s).empty());
    const auto changes = update(0, 4s);
    EXPECT_EQ(changes.size(), rigs_.size() - RigDemand::most_rigs);
    for (const char* far : {"-80", "80", "-60", "60"}) {
        ASSERT_TRUE(changes.contains(far)) << far;
        EXPECT_FALSE(changes.at(far));
    }
    EXPECT_TRUE(update(0, 5s).empty());
}

TEST_F(RigDemandTest, RequestsAUsefulRigAtOnce) {
    update(0, 0s);
    update(0, 4s);
    const auto changes = update(80, 4100ms);
    ASSERT_TRUE(changes.contains("80"));
    EXPECT_TRUE(changes.at("80"));
    // The rigs that it turned away from are still held.
    for (const auto& [rig, streaming] : changes) EXPECT_TRUE(streaming) << rig;
}

TEST_F(RigDemandTest, KeepsTheRigsOfTwoViews) {
    const std::array views{view_at(-80), view_at(80)};
    demand_.update(views, start_);
    std::map<std::string, bool> changes;
    for (const auto& change : demand_.update(views, start_ + 4s))
        changes[change.rig] = change.streaming;
    for (const char* needed : {"-80", "-60", "-40", "40", "60", "80"})
        EXPECT_FALSE(changes.contains(needed)) << needed;
    demand_.update(std::array{views[0]}, start_ + 5s);
    for (const auto& change : demand_.update(std::array{views[0]}, start_ + 9s))
        changes[change.rig] = change.streaming;
    ASSERT_TRUE(changes.contains("80")) << "no view needs it any more";
    EXPECT_FALSE(changes["80"]);
}

TEST_F(RigDemandTest, LeavesASmallStageAlone) {
    RigDemand demand;
    demand.see(std::span(rigs_).first(4));
    EXPECT_TRUE(demand.update(std::array{view_at(0)}, start_).empty());
    EXPECT_TRUE(demand.update(std::array{view_at(0)}, start_ + 60s).empty());
}

TEST_F(RigDemandTest, ARigThatLeftTheStageTakesNoOthersPlace) {
    FrameSet set;
    for (const DepthView& rig : rigs_)
        if (rig.name != "0") set.slots.push_back({rig.name, nullptr, Absence::late});
    demand_.forget_others(set);
    EXPECT_TRUE(update(0, 0s).empty());
    const auto changes = update(0, 4s);
    EXPECT_FALSE(changes.contains("0"));
    EXPECT_EQ(changes.size(), rigs_.size() - 1 - RigDemand::most_rigs);
}

}  // namespace
}  // namespace vantage
