#include "host_app/output/output_supervisor.h"

#include <set>

#include "common/base/error.h"
#include "host_app/output/media/picture_encoder.h"

namespace vantage {
namespace {

/// How long a question is shown.
constexpr std::chrono::seconds question_duration{3};
/// The function key of output 1.
constexpr int first_output_key = 5;

}  // namespace

class OutputSupervisor::Fan final : public PictureSink {
  public:
    explicit Fan(const OutputSupervisor& desk) : desk_(desk) {}
    std::string name() const override { return ""; }
    void take(const ProgrammePicture& picture) override {
        for (const std::shared_ptr<Output>& output : desk_.outputs()) output->take(picture);
    }

  private:
    const OutputSupervisor& desk_;
};

OutputSupervisor::OutputSupervisor(Settings settings) : settings_(std::move(settings)) {
    check(settings_);
    settings_.format.encoders = std::make_shared<EncoderPool>();
    for (const std::string& url : settings_.urls) add(url);
}

void OutputSupervisor::check(const Settings& settings) {
    std::set<std::string> places;
    for (const std::string& url : settings.urls) {
        (void)plan_output(url, settings.format);
        if (!places.insert(OutputUrl::parse(url).place).second)
            fail("two outputs are to go to {}", OutputUrl::parse(url).shown);
    }
    if (!settings.format.encoder.empty()) require_known_encoder(settings.format.encoder);
}

std::unique_ptr<PictureSink> OutputSupervisor::sink() { return std::make_unique<Fan>(*this); }

std::size_t OutputSupervisor::add(const std::string& url) {
    const std::lock_guard adding(adding_);
    OutputPlan plan = plan_output(url, settings_.format);
    if (plan.is_encoded && !has_encoder_) {
        settings_.format.encoder =
            choose_encoder(settings_.format.encoder, {.width_px = settings_.format.width_px,
                                                      .height_px = settings_.format.height_px,
                                                      .rate_hz = settings_.format.rate_hz});
        has_encoder_ = true;
        plan = plan_output(url, settings_.format);
    }
    const bool takes_stdout = plan.takes_stdout, begins = plan.begins;
    const std::shared_ptr<ScreenFeed> screen = plan.screen;
    auto output =
        std::make_shared<Output>(std::move(plan), settings_.format, settings_.pulse_rate_hz);
    if (begins) output->start();
    const std::lock_guard lock(mutex_);
    takes_stdout_ = takes_stdout_ || takes_stdout;
    if (screen) screens_.push_back(screen);
    outputs_.push_back(std::move(output));
    return outputs_.size() - 1;
}

void OutputSupervisor::start(std::size_t number) { outputs().at(number)->start(); }

void OutputSupervisor::stop(std::size_t number) { outputs().at(number)->stop(); }

bool OutputSupervisor::is_wanted(std::size_t number) const {
    return outputs().at(number)->is_wanted();
}

void OutputSupervisor::finish() {
    settings_.format.encoders->flush();
    for (const std::shared_ptr<Output>& output : outputs()) output->finish();
}

std::vector<OutputState> OutputSupervisor::states() const {
    std::vector<OutputState> states;
    for (const std::shared_ptr<Output>& output : outputs()) states.push_back(output->state());
    return states;
}

bool OutputSupervisor::takes_stdout() const {
    const std::lock_guard lock(mutex_);
    return takes_stdout_;
}

std::vector<std::shared_ptr<ScreenFeed>> OutputSupervisor::screens() const {
    const std::lock_guard lock(mutex_);
    return screens_;
}

std::vector<std::shared_ptr<Output>> OutputSupervisor::outputs() const {
    const std::lock_guard lock(mutex_);
    return outputs_;
}

void OutputSwitch::press(int number, MonotonicTime now) {
    const auto at = static_cast<std::size_t>(number - 1);
    const std::vector<OutputState> states = outputs_.states();
    if (number < 1 || at >= states.size()) {
        asked_ = {number, fmt::format("There is no output {}; add it with --output", number),
                  now + question_duration};
        return;
    }
    const bool runs = outputs_.is_wanted(at);
    const bool is_second = asked_ && asked_->number == number && now < asked_->until;
    asked_.reset();
    if (!runs)
        outputs_.start(at);
    else if (is_second)
        outputs_.stop(at);
    else
        asked_ = {number,
                  fmt::format("Press F{} again to stop {}", first_output_key + number - 1,
                              states[at].name),
                  now + question_duration};
}

std::string OutputSwitch::question(MonotonicTime now) const {
    return asked_ && now < asked_->until ? asked_->words : "";
}

}  // namespace vantage
