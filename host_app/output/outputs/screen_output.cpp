#include <charconv>
#include <chrono>
#include <thread>

#include "common/base/error.h"
#include "host_app/output/output_target.h"
#include "host_app/output/screen_feed.h"

namespace vantage {
namespace {

class ScreenTarget final : public OutputTarget {
  public:
    ScreenTarget(std::shared_ptr<ScreenFeed> feed, const OutputPatience& patience)
        : feed_(std::move(feed)) {
        feed_->ask();
        constexpr std::chrono::milliseconds look{5};
        while (feed_->state() == ScreenFeed::State::asked && !patience.is_over())
            std::this_thread::sleep_for(look);
        if (feed_->state() == ScreenFeed::State::shown) return;
        const std::string why = feed_->failure();
        feed_->close();
        fail("{}", why.empty() ? "no window came" : why);
    }
    ~ScreenTarget() override { feed_->close(); }
    void write(const ColourImage& picture, std::int64_t, const std::string&) override {
        feed_->put(picture);
        bytes_ += picture.total() * picture.elemSize();
    }
    std::uint64_t bytes() const override { return bytes_; }

  private:
    std::shared_ptr<ScreenFeed> feed_;
    std::uint64_t bytes_ = 0;
};

OutputPlan plan(const OutputUrl& url, const OutputFormat&) {
    url.require_options_of({});
    int monitor = 0;
    const char* end = url.place.data() + url.place.size();
    constexpr int most_monitors = 16;
    if (std::from_chars(url.place.data(), end, monitor).ptr != end || monitor < 1 ||
        monitor > most_monitors)
        fail("the output {}: behind screen: stands the number of a monitor, from 1 on", url.shown);
    const auto feed = std::make_shared<ScreenFeed>(monitor);
    return {.name = url.shown,
            .is_stream = true,
            .is_encoded = false,
            .screen = feed,
            .open = [feed](const OutputPatience& patience) {
                return std::make_unique<ScreenTarget>(feed, patience);
            }};
}

}  // namespace

OutputEntry screen_output_entry() {
    return {"screen", "screen:N (the whole of a monitor, counted from 1)", plan};
}

}  // namespace vantage
