#include <cmath>
#include <thread>
#include <variant>

#include "common/base/error.h"
#include "common/base/files/output_path.h"
#include "common/base/time/pulse_grid.h"
#include "host_app/ltc/ltc_writer.h"
#include "host_app/output/media/alsa_playback.h"
#include "host_app/output/media/wav_file.h"
#include "host_app/output/output_target.h"

namespace vantage {
namespace {

constexpr std::string_view device_scheme = "alsa:";

/// Frame counts of a programme's rate as time code.
struct LtcRate {
    double frames_a_second = 25;
    int ticks_a_frame = 1;
    SmpteCount ticks, frames;  ///< counts of the ticks' codes and of the sound's codes
};

/// Empty if there is no linear time code of this rate.
std::optional<LtcRate> ltc_rate_of(double rate_hz) {
    const double rate = PulseGrid(rate_hz).rate_hz();
    for (const double each : {24.0, 25.0, 30000.0 / 1001, 30.0})
        for (const int ticks : {1, 2}) {
            if (std::abs(rate - ticks * each) > 1e-6 || (each == 24 && ticks == 2)) continue;
            const bool is_drop_frame = std::abs(each - 30) > 1e-6 && each > 29;
            const int numbers = static_cast<int>(std::lround(each));
            return LtcRate{each, ticks, {ticks * numbers, is_drop_frame}, {numbers, is_drop_frame}};
        }
    return std::nullopt;
}

class LtcTarget final : public OutputTarget {
  public:
    LtcTarget(const std::variant<std::filesystem::path, std::string>& to, const LtcRate& rate,
              const OutputPatience& patience)
        : rate_(rate), patience_(patience), wheel_(rate.ticks), writer_(rate.frames_a_second) {
        if (const auto* file = std::get_if<std::filesystem::path>(&to))
            file_.emplace(*file);
        else
            device_.emplace(std::get<std::string>(to));
    }

    void write(const ColourImage&, std::int64_t tick, const std::string& timecode) override {
        // Ticks of dropped frames count too.
        for (; next_tick_ < tick; ++next_tick_) add(std::nullopt);
        add(SmpteCode::parse(timecode));
        ++next_tick_;
    }
    void finish() override {
        if (file_) file_->finish();
    }
    std::uint64_t bytes() const override { return file_ ? file_->bytes() : bytes_; }

  private:
    void add(const std::optional<SmpteCode>& picture) {
        const std::optional<SmpteCode> code = wheel_.next(picture);
        if (!code) {
            silence();
            return;
        }
        // A time code frame of two ticks starts at the even tick.
        const std::int64_t number = *rate_.ticks.frame_of(*code);
        if (rate_.ticks_a_frame == 2 && number % 2 != 0) {
            if (!in_frame_) silence();
            in_frame_ = false;
            return;
        }
        in_frame_ = rate_.ticks_a_frame == 2;
        give(writer_.frame(rate_.frames.code_of(number / rate_.ticks_a_frame)));
    }
    void silence() {
        const double samples = sound_rate_hz / rate_.frames_a_second / rate_.ticks_a_frame;
        give(std::vector<float>(static_cast<std::size_t>(std::lround(samples))));
    }
    void give(const std::vector<float>& samples) {
        bytes_ += sizeof(float) * samples.size();
        if (file_) {
            file_->add(samples);
            return;
        }
        constexpr std::chrono::milliseconds look{5};
        while (!device_->play(samples)) {
            if (patience_.is_over()) fail("its device takes nothing");
            std::this_thread::sleep_for(look);
        }
    }

    LtcRate rate_;
    const OutputPatience& patience_;
    LtcFlywheel wheel_;
    LtcWriter writer_;
    std::optional<WavFile> file_;
    std::optional<AlsaPlayback> device_;
    std::int64_t next_tick_ = 0;
    bool in_frame_ = false;
    std::uint64_t bytes_ = 0;
};

OutputPlan plan(const OutputUrl& url, const OutputFormat& format) {
    url.require_options_of({});
    const std::optional<LtcRate> rate = ltc_rate_of(format.rate_hz);
    if (!rate)
        fail(
            "the output {}: there is no linear time code of {:g} frames per second, only of 24, "
            "25, 29.97, 30, 50, 59.94 and 60",
            url.shown, format.rate_hz);
    OutputPlan plan;
    plan.name = url.shown;
    plan.is_encoded = false;
    if (url.place.starts_with(device_scheme)) {
        plan.is_stream = true;
        plan.open = [device = url.place.substr(device_scheme.size()),
                     rate](const OutputPatience& patience) {
            return std::make_unique<LtcTarget>(device, *rate, patience);
        };
        return plan;
    }
    const std::filesystem::path file = url.place;
    if (file.extension() != ".wav")
        fail("the output {}: linear time code goes to alsa:DEVICE or a file that ends in .wav",
             url.shown);
    require_writable_output(file, {});
    if (!format.overwrites && std::filesystem::exists(file))
        fail("{} is there already: take another name, or --overwrite", file.string());
    plan.open = [file, rate, overwrites = format.overwrites](const OutputPatience& patience) {
        return std::make_unique<LtcTarget>(overwrites ? file : free_path(file), *rate, patience);
    };
    return plan;
}

}  // namespace

OutputEntry ltc_output_entry() {
    return {"ltc", "ltc:alsa:DEVICE or ltc:FILE.wav (the programme's time code as sound)", plan};
}

}  // namespace vantage
