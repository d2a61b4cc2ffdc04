#include "host_app/session/corridor_fields.h"

#include <numbers>

#include <gtest/gtest.h>

namespace vantage {
namespace {

/// The corridor of two rigs 4 m in front of the stage.
std::shared_ptr<const Corridor> corridor() {
    std::vector<CorridorRig> rigs;
    for (const double azimuth : {-0.25, 0.25}) {
        OrbitView view;
        view.azimuth_rad = azimuth;
        view.distance_m = 4;
        rigs.push_back({view.world_from_camera(), 0.5, 0.4});
    }
    return std::make_shared<const Corridor>(rigs, StageExtent{}, 0.5625);
}

TEST(CorridorFieldsTest, AreCoveredAtTheRigsAndNotBehindTheStage) {
    CorridorFields fields;
    const auto there = corridor();
    for (int i = 0; i < 100; ++i) fields.follow(there, OrbitView{}, 6);
    ASSERT_FALSE(fields.fields().empty());
    const auto place_at = [&](double azimuth_rad, double distance_m) {
        for (const DeskPlan::Field& field : fields.fields())
            if (std::abs(field.azimuth_rad - azimuth_rad) <= 0.5 * field.width_rad &&
                field.from_m <= distance_m && distance_m < field.to_m)
                return field.place;
        ADD_FAILURE() << "no field there";
        return CorridorPlace::edge;
    };
    EXPECT_EQ(place_at(0, 4.2), CorridorPlace::inside);
    EXPECT_EQ(place_at(std::numbers::pi, 4.2), CorridorPlace::beyond);
}

TEST(CorridorFieldsTest, AreComputedInPartsAndShownWhenComplete) {
    CorridorFields fields;
    const auto there = corridor();
    fields.follow(there, OrbitView{}, 6);
    EXPECT_TRUE(fields.fields().empty());
    int calls = 1;
    while (fields.fields().empty() && calls < 1000) {
        fields.follow(there, OrbitView{}, 6);
        ++calls;
    }
    EXPECT_GT(calls, 3);
    EXPECT_LT(calls, 50);
    OrbitView aside;
    aside.pivot_m.x() = 1;
    fields.follow(there, aside, 6);
    EXPECT_EQ(fields.pivot_m().x(), 0) << "those of before, until the new ones are all there";
    for (int i = 0; i < 50; ++i) fields.follow(there, aside, 6);
    EXPECT_EQ(fields.pivot_m().x(), 1);
}

TEST(CorridorFieldsTest, AreEmptyWithoutACorridor) {
    CorridorFields fields;
    fields.follow(nullptr, OrbitView{}, 6);
    EXPECT_TRUE(fields.fields().empty());
}

}  // namespace
}  // namespace vantage
