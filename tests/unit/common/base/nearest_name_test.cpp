#include "common/base/cli/nearest_name.h"

#include <vector>

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(EditDistance, CountsTheLettersToChange) {
    EXPECT_EQ(edit_distance("", ""), 0u);
    EXPECT_EQ(edit_distance("", "abc"), 3u);
    EXPECT_EQ(edit_distance("matcher", "mathcer"), 1u);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
    EXPECT_EQ(edit_distance("preset", "presets"), 1u);
    EXPECT_EQ(edit_distance("ab", "ba"), 1u);
    EXPECT_EQ(edit_distance("ca", "abc"), 3u);
}

TEST(NearestName, FindsTheMistypedOne) {
    const std::vector<std::string> known = {"matcher", "preset", "disparities", "fill"};
    EXPECT_EQ(nearest_name("mathcer", known), "matcher");
    EXPECT_EQ(nearest_name("disparitys", known), "disparities");
    EXPECT_EQ(nearest_name("fil", known), "fill");
}

TEST(NearestName, SuggestsNothingWhereNothingIsNear) {
    const std::vector<std::string> known = {"matcher", "preset"};
    EXPECT_EQ(nearest_name("colour", known), "");
    EXPECT_EQ(nearest_name("x", known), "");
    EXPECT_EQ(suggest_name("colour", known), "the ones there are: matcher, preset");
    EXPECT_EQ(suggest_name("presett", known), "the nearest is 'preset'");
}

}  // namespace
}  // namespace vantage
