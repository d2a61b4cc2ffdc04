#include "rig_firmware/trigger/bar_driver.h"

#include <functional>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

/// What was asked of the lines; fails from a certain call on.
struct Book {
    std::mutex mutex;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> calls;  ///< lit, changed
    std::size_t fails_at = SIZE_MAX;
    std::size_t count() {
        const std::lock_guard lock(mutex);
        return calls.size();
    }
};

class BookLines final : public BarLines {
  public:
    explicit BookLines(Book& book) : book_(book) {}
    void set(std::uint32_t lit, std::uint32_t changed) override {
        const std::lock_guard lock(book_.mutex);
        if (book_.calls.size() == book_.fails_at) fail("the lines are gone");
        book_.calls.emplace_back(lit, changed);
    }
    std::string text() const override { return "a book"; }

  private:
    Book& book_;
};

void wait_until(const std::function<bool()>& done) {
    for (int i = 0; i < 5000 && !done(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(BarDriver, changes_what_differs_and_leaves_the_bar_dark) {
    Book book;
    const SyncBar bar(6, std::chrono::milliseconds(1));
    BarDriver driver(bar, std::make_unique<BookLines>(book), std::chrono::nanoseconds(0), 0);
    wait_until([&] { return book.count() >= 30; });
    driver.stop();
    ASSERT_GE(book.calls.size(), 31u);
    const auto [last_lit, last_changed] = book.calls.back();
    EXPECT_EQ(last_lit, 0u);
    EXPECT_EQ(last_changed, ~0u) << "whatever was lit";
    std::uint32_t lit = 0;
    for (std::size_t i = 0; i + 1 < book.calls.size(); ++i) {
        EXPECT_LT(book.calls[i].first, 64u);
        EXPECT_EQ(book.calls[i].second, book.calls[i].first ^ lit);
        lit = book.calls[i].first;
    }
    EXPECT_EQ(driver.status().shown, book.calls.size() - 1);
    EXPECT_EQ(driver.report().front(),
              "6 LEDs count steps of 1000 us, all over again every 64 ms, on a book");
}

TEST(BarDriver, says_that_its_lines_are_gone) {
    Book book;
    book.fails_at = 3;
    BarDriver driver(SyncBar(6, std::chrono::milliseconds(1)), std::make_unique<BookLines>(book),
                     std::chrono::nanoseconds(0), 0);
    const auto failure = [&] { return thrown_sentence([&] { driver.rethrow_failure(); }); };
    wait_until([&] { return !failure().empty(); });
    EXPECT_EQ(failure(), "the lines are gone");
    EXPECT_EQ(book.calls.size(), 3u);
}

}  // namespace
}  // namespace vantage
