#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "common/base/bounded_queue.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time/kernel_clock.h"
#include "common/base/time/timecode.h"
#include "host_app/control/ports/control_port.h"
#include "host_app/ltc/ltc_sound.h"
#include "host_app/sound/sound_decoder.h"
#include "host_app/sound/sound_source.h"

namespace vantage {
namespace {

constexpr std::string_view device_scheme = "alsa:";
/// Largest number of waiting blocks of a device, 10 ms each.
constexpr std::size_t most_waiting_blocks = 200;

/// Peak level below which sound counts as silence.
constexpr float silence_peak = 0.001F;
/// Time for which sound without a valid code is tolerated before it is reported.
constexpr double patience_s = 5;

/// Block of interleaved samples of one or more channels.
struct HeardBlock {
    std::int64_t first = 0;
    std::vector<float> samples;
};

/// Interface of a sound source whose samples have times.
class HeardSound {
  public:
    virtual ~HeardSound() = default;
    virtual std::optional<HeardBlock> next(std::chrono::milliseconds most) = 0;
    virtual std::size_t channels() const { return sound_channels; }
    virtual int rate_hz() const { return sound_rate_hz; }
    virtual TaiTime time_of(std::int64_t sample) const { return time_of_sound(sample); }
    virtual std::uint64_t dropped() const { return 0; }
    /// True at the end of a file.
    virtual bool is_over() const { return false; }
};

class HeardDevice final : public HeardSound {
  public:
    explicit HeardDevice(const OutputUrl& url)
        : queue_(std::make_shared<BoundedQueue<SoundBlock>>(most_waiting_blocks)),
          source_(open_sound(url.option("channels")
                                 ? url.place + "?channels=" + *url.option("channels")
                                 : url.place,
                             [queue = queue_](const SoundBlock& block) { queue->push(block); })) {}
    std::optional<HeardBlock> next(std::chrono::milliseconds most) override {
        std::optional<SoundBlock> block = queue_->pop_for(most);
        if (!block) return std::nullopt;
        return HeardBlock{block->first, std::move(block->samples)};
    }
    std::uint64_t dropped() const override { return queue_->dropped_count(); }

  private:
    std::shared_ptr<BoundedQueue<SoundBlock>> queue_;
    std::shared_ptr<SoundSource> source_;
};

/// Plays a file in real time from now on, with its own channels and its own rate: a resampler would
/// round the edges that carry the code.
class HeardFile final : public HeardSound {
  public:
    explicit HeardFile(const OutputUrl& url)
        : decoder_(SoundDecoder::as_stored(url.place)), start_(TaiClock::now()) {}
    std::optional<HeardBlock> next(std::chrono::milliseconds most) override {
        const std::int64_t at_once = decoder_.rate_hz() / 50;
        const TaiTime due = time_of(next_ + at_once);
        if (is_over_ || due > TaiClock::now() + most) {
            std::this_thread::sleep_for(most);
            return std::nullopt;
        }
        sleep_until(due);
        HeardBlock block{next_, decoder_.next(static_cast<std::size_t>(at_once))};
        const auto count = static_cast<std::int64_t>(block.samples.size() / channels());
        is_over_ = count < at_once;
        next_ += count;
        return block;
    }
    std::size_t channels() const override { return decoder_.channels(); }
    int rate_hz() const override { return decoder_.rate_hz(); }
    TaiTime time_of(std::int64_t sample) const override {
        return start_ + from_s(static_cast<double>(sample) / decoder_.rate_hz());
    }
    bool is_over() const override { return is_over_; }

  private:
    SoundDecoder decoder_;
    TaiTime start_;
    std::int64_t next_ = 0;
    bool is_over_ = false;
};

/// Channel of the option `channels=2` that is decoded; empty: all channels.
std::optional<std::size_t> channel_of(const OutputUrl& url, std::size_t channels) {
    if (!url.option("channels")) return std::nullopt;
    constexpr int most_channels = 256;
    const std::optional<int> channel = url.number("channels", 1, most_channels);
    if (static_cast<std::size_t>(*channel) > channels)
        fail("control {}: the file has {} channels, but no channel {}", url.shown, channels,
             *channel);
    return static_cast<std::size_t>(*channel) - 1;
}

class LtcPort final : public ControlPort {
  public:
    LtcPort(const OutputUrl& url, const ControlBench& bench) : name_(url.shown), bench_(bench) {
        url.require_options_of({"channels"});
        const bool is_device = url.place.starts_with(device_scheme);
        if (is_device)
            sound_ = std::make_unique<HeardDevice>(url);
        else
            sound_ = std::make_unique<HeardFile>(url);
        const std::optional<std::size_t> only =
            is_device ? std::nullopt : channel_of(url, sound_->channels());
        for (std::size_t i = 0; i < sound_->channels(); ++i)
            if (!only || i == *only) channels_.emplace_back(i, sound_->rate_hz());
    }

    void serve(std::chrono::milliseconds most) override {
        const std::optional<HeardBlock> sound = sound_->next(most);
        stats_.dropped = sound_->dropped();
        if (sound) hear(*sound);
        if (sound_->is_over() && !told_end_) {
            told_end_ = true;
            if (stats_.obeyed == 0) tell_silence("in the whole file");
        }
    }

  private:
    /// One channel and the result of its decoder.
    struct Channel {
        Channel(std::size_t at, int rate_hz) : place(at), reader(rate_hz) {}
        std::size_t place;
        LtcReader reader;
        std::uint64_t malformed = 0;
        float peak = 0;  ///< peak level since the last code
    };

    void hear(const HeardBlock& sound) {
        const std::size_t all = sound_->channels();
        const std::uint64_t obeyed = stats_.obeyed;
        std::vector<float> samples;
        for (Channel& channel : channels_) {
            samples.clear();
            for (std::size_t i = channel.place; i < sound.samples.size(); i += all)
                samples.push_back(sound.samples[i]);
            for (const float sample : samples)
                channel.peak = std::max(channel.peak, std::abs(sample));
            const std::vector<LtcReading> readings = channel.reader.hear(samples, sound.first);
            if (!readings.empty() && !heard_) note_channel(channel);
            const std::uint64_t malformed =
                channel.reader.malformed() -
                std::exchange(channel.malformed, channel.reader.malformed());
            // A code was found in another channel; this one holds other sound.
            if (heard_ && *heard_ != channel.place) continue;
            for (const LtcReading& reading : readings) take(reading);
            if (malformed == 0) continue;
            stats_.malformed += malformed;
            stats_.last_refusal =
                "linear time code that is invalid, or does not follow the code before it";
        }
        if (stats_.obeyed > obeyed) {
            without_code_s_ = 0;
            for (Channel& channel : channels_) channel.peak = 0;
            return;
        }
        const double before_s = without_code_s_;
        without_code_s_ += static_cast<double>(sound.samples.size() / all) / sound_->rate_hz();
        if (before_s >= patience_s || without_code_s_ < patience_s) return;
        heard_.reset();
        tell_silence(fmt::format("for {:g} s", patience_s));
    }

    void note_channel(const Channel& channel) {
        heard_ = channel.place;
        log_info("control {}: time code is heard on channel {} of {}, at {} Hz", name_,
                 channel.place + 1, sound_->channels(), sound_->rate_hz());
    }

    void tell_silence(const std::string& how_long) {
        std::string levels;
        constexpr double db_per_decade = 20;
        for (const Channel& channel : channels_)
            levels += fmt::format("{}channel {} {}", levels.empty() ? "" : ", ", channel.place + 1,
                                  channel.peak < silence_peak
                                      ? std::string("is silent")
                                      : fmt::format("peaks at {:.0f} dBFS",
                                                    db_per_decade * std::log10(channel.peak)));
        stats_.told = fmt::format("no time code heard {}: {}", how_long, levels);
        log_warning("control {}: {}", name_, stats_.told);
    }

    void take(const LtcReading& reading) {
        ++stats_.obeyed;
        const SmpteCount count = count_of(reading);
        const double rate_hz =
            count.is_drop_frame ? 30000.0 / 1001 : static_cast<double>(count.numbers_a_second);
        // The middle of the frame is used, since its start is known to a few samples only.
        const TaiTime middle = sound_->time_of(reading.first) + from_s(0.5 / rate_hz);
        const std::optional<SmpteCode> house =
            SmpteCode::parse(TimecodeClock(rate_hz).at(middle, read_kernel_clock().tai_offset_s));
        const std::optional<std::int64_t> here = house ? count.frame_of(*house) : std::nullopt;
        const std::int64_t ahead = here ? count.between(*count.frame_of(reading.code), *here) : 0;
        bench_.ltc.put({reading.code.text(), ahead});
        stats_.told = reading.code.text() + ", " + words_of_ltc(ahead);
        tell(reading, ahead);
    }
    /// Logs a difference from the house time code that is stable and new.
    void tell(const LtcReading& reading, std::int64_t ahead) {
        constexpr int stays = 25;
        same_ = ahead == last_ahead_ ? same_ + 1 : 0;
        last_ahead_ = ahead;
        if (same_ < stays || told_ahead_ == ahead) return;
        told_ahead_ = ahead;
        log_info("control {}: {}, {}", name_, reading.code.text(), words_of_ltc(ahead));
    }

    std::string name_;
    ControlBench bench_;
    std::unique_ptr<HeardSound> sound_;
    std::vector<Channel> channels_;
    std::optional<std::size_t> heard_;  ///< channel that carries the code
    double without_code_s_ = 0;
    bool told_end_ = false;
    int same_ = 0;
    std::int64_t last_ahead_ = 0;
    std::optional<std::int64_t> told_ahead_;
};

}  // namespace

PortEntry ltc_port_entry() {
    return {"ltc",
            "ltc://alsa:DEVICE or ltc://FILE (?channels=2) (linear time code, shown beside the "
            "house's)",
            [](const OutputUrl& url, const ControlBench& bench) {
                return std::make_unique<LtcPort>(url, bench);
            }};
}

}  // namespace vantage
