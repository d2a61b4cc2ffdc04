#include "common/receive/outage_counter.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

const MonotonicTime host_start = monotonic_from_ns(0) + 1h;

TEST(OutageCounter, ARigBeforeItsFirstMessageIsNoOutage) {
    OutageCounter book;
    book.note(false, std::nullopt);
    EXPECT_EQ(book.outages(), 0u);
    EXPECT_EQ(book.length(host_start), 0s);
}

TEST(OutageCounter, CountsFromTheLastMessageToTheNext) {
    OutageCounter book;
    book.note(true, host_start);
    book.note(false, host_start + 1s);
    EXPECT_EQ(book.outages(), 1u);
    EXPECT_EQ(book.length(host_start + 4s), 3s) << "it lasts";
    book.note(false, host_start + 1s);
    book.note(true, host_start + 10s);
    EXPECT_EQ(book.outages(), 1u);
    EXPECT_EQ(book.length(host_start + 20s), 9s);
}

TEST(OutageCounter, SumsOutages) {
    OutageCounter book;
    for (const auto at : {0s, 10s}) {
        book.note(true, host_start + at);
        book.note(false, host_start + at);
        book.note(true, host_start + at + 2s);
    }
    EXPECT_EQ(book.outages(), 2u);
    EXPECT_EQ(book.length(host_start + 60s), 4s);
}

}  // namespace
}  // namespace vantage
