#include "common/receive/link_budget.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

/// 1456x1088 colour and 640x400 depth.
RigWeight full_size(const char* name) {
    return {.rig = name,
            .frames = 30,
            .colour_bytes = 700'000,
            .other_bytes = 120'000,
            .ladder = {{85, 700'000}, {75, 520'000}, {60, 380'000}, {50, 320'000}}};
}

std::vector<RigWeight> four_full_size() {
    return {full_size("a"), full_size("b"), full_size("c"), full_size("d")};
}

TEST(LinkBudget, IncludesProtocolOverhead) {
    const LinkBudget budget = plan_links({full_size("north")}, 30, {});
    ASSERT_EQ(budget.rigs.size(), 1u);
    // 820 kB, 30 a second, with 7 % of packets' headers.
    EXPECT_NEAR(budget.rigs[0].mbit_s, 8 * 0.82 * 30 * 1.073, 0.5);
    EXPECT_NEAR(budget.rigs[0].share, budget.rigs[0].mbit_s / 800, 1e-9);
    EXPECT_EQ(budget.host_mbit_s, budget.rigs[0].mbit_s);
    EXPECT_TRUE(budget.fits());
    EXPECT_TRUE(budget.proposals.empty());
}

TEST(LinkBudget, CountsAQuarterMoreForARigOverSrt) {
    std::vector<RigWeight> weights{full_size("near"), full_size("far")};
    weights[1].by_datagrams = true;
    const LinkBudget budget = plan_links(weights, 30, {});
    EXPECT_NEAR(budget.rigs[1].mbit_s, 1.25 * budget.rigs[0].mbit_s, 1e-9);
    EXPECT_NEAR(budget.rigs[1].share, 1.25 * budget.rigs[0].share, 1e-9);
    EXPECT_NEAR(budget.host_mbit_s, 2.25 * budget.rigs[0].mbit_s, 1e-9);
}

TEST(LinkBudget, ProposesQualitiesForFourRigsOnOneGigabit) {
    const LinkBudget budget = plan_links(four_full_size(), 30, {});
    for (const LinkBudget::Rig& rig : budget.rigs) EXPECT_LT(rig.share, 1);
    EXPECT_GT(budget.host_share, 1);
    EXPECT_FALSE(budget.fits());
    ASSERT_EQ(budget.proposals.size(), 2u);
    EXPECT_EQ(budget.proposals[0].rate_divisor, 1);
    EXPECT_EQ(budget.proposals[0].jpeg_quality, 75);
    EXPECT_EQ(budget.proposals[1].rate_divisor, 2);
    EXPECT_EQ(budget.proposals[1].jpeg_quality, std::nullopt);
    for (const LinkBudget::Proposal& proposal : budget.proposals)
        EXPECT_LE(proposal.host_mbit_s, 800);
}

TEST(LinkBudget, NamesARigWhoseLinkIsTooSlow) {
    std::vector<RigWeight> weights = four_full_size();
    weights[2].colour_bytes *= 4;
    const LinkBudget budget = plan_links(weights, 30, {.rig_mbit_s = 500, .host_mbit_s = 10'000});
    EXPECT_LT(budget.host_share, 1);
    EXPECT_FALSE(budget.fits());
    for (std::size_t i = 0; i < budget.rigs.size(); ++i)
        EXPECT_EQ(budget.rigs[i].share > 1, i == 2);
    EXPECT_FALSE(budget.proposals.empty());
}

TEST(LinkBudget, ProposesTheLargestSmallerPicturesThatFit) {
    std::vector<RigWeight> weights = four_full_size();
    for (RigWeight& weight : weights) weight.smaller = {{0.9, 0.99}, {0.75, 0.6}, {0.5, 0.3}};
    const LinkBudget budget = plan_links(weights, 30, {});
    ASSERT_EQ(budget.proposals.size(), 3u);
    EXPECT_EQ(budget.proposals[2].scale, 0.75);
    EXPECT_EQ(budget.proposals[2].rate_divisor, 1);
    // 0.6 of 700 kB, and 0.75 by 0.75 of 120 kB, of four rigs.
    EXPECT_NEAR(budget.proposals[2].host_mbit_s, 4 * 8 * (0.42 + 0.0675) * 30 * 1.073, 1);
}

TEST(LinkBudget, ProposesFewerRigsPerProgramme) {
    LinkLimits limits{.host_mbit_s = 600, .programme_rigs = 2};
    const LinkBudget budget = plan_links(four_full_size(), 30, limits);
    ASSERT_FALSE(budget.proposals.empty());
    EXPECT_EQ(budget.proposals.back().rigs, 2u);
    EXPECT_NEAR(budget.proposals.back().host_mbit_s, budget.host_mbit_s / 2, 1e-9);
    limits.rig_mbit_s = 100;
    for (const LinkBudget::Proposal& one : plan_links(four_full_size(), 30, limits).proposals)
        EXPECT_EQ(one.rigs, 0u) << "a rig's own link is no wider by that";
    limits = {.host_mbit_s = 600, .programme_rigs = 4};
    for (const LinkBudget::Proposal& one : plan_links(four_full_size(), 30, limits).proposals)
        EXPECT_EQ(one.rigs, 0u) << "all are needed";
}

TEST(LinkBudget, ProposesNothingIfNothingFits) {
    const LinkBudget budget = plan_links(four_full_size(), 30, {.host_mbit_s = 10});
    EXPECT_FALSE(budget.fits());
    EXPECT_TRUE(budget.proposals.empty());
}

}  // namespace
}  // namespace vantage
