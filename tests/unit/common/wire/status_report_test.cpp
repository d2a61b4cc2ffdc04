#include "common/wire/status_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vantage {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(StatusReport, ReportsRefusedConnections) {
    RigHealth health;
    EXPECT_THAT(health_text(health), Not(HasSubstr("strangers")));
    EXPECT_EQ(to_json(health)["refused_connections"], 0);
    health.refused_connections = 900;
    EXPECT_THAT(health_text(health), HasSubstr("refused 900 connections that are not from a host"));
    EXPECT_EQ(to_json(health)["refused_connections"], 900);
}

}  // namespace
}  // namespace vantage
