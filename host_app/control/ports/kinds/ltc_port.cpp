#include <cstdlib>
#include <thread>

#include "common/base/bounded_queue.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time/kernel_clock.h"
#include "common/base/time/timecode.h"
#include "host_app/control/ports/control_port.h"
#include "host_app/ltc/ltc_reader.h"
#include "host_app/sound/sound_decoder.h"
#include "host_app/sound/sound_source.h"

namespace vantage {
namespace {

constexpr std::string_view device_scheme = "alsa:";
/// Of a device, 10 ms each.
constexpr std::size_t most_waiting_blocks = 200;

/// Sound with the times at which it is heard.
class HeardSound {
  public:
    virtual ~HeardSound() = default;
    virtual std::optional<SoundBlock> next(std::chrono::milliseconds most) = 0;
    virtual std::uint64_t dropped() const { return 0; }
};

class HeardDevice final : public HeardSound {
  public:
    explicit HeardDevice(const OutputUrl& url)
        : queue_(std::make_shared<BoundedQueue<SoundBlock>>(most_waiting_blocks)),
          source_(open_sound(url.option("channels")
                                 ? url.place + "?channels=" + *url.option("channels")
                                 : url.place,
                             [queue = queue_](const SoundBlock& block) { queue->push(block); })) {}
    std::optional<SoundBlock> next(std::chrono::milliseconds most) override {
        return queue_->pop_for(most);
    }
    std::uint64_t dropped() const override { return queue_->dropped_count(); }

  private:
    std::shared_ptr<BoundedQueue<SoundBlock>> queue_;
    std::shared_ptr<SoundSource> source_;
};

/// A file as if it were played from now on.
class HeardFile final : public HeardSound {
  public:
    explicit HeardFile(const OutputUrl& url)
        : decoder_(url.place), next_(sound_sample_at(TaiClock::now())) {}
    std::optional<SoundBlock> next(std::chrono::milliseconds most) override {
        constexpr std::int64_t at_once = sound_rate_hz / 50;
        const TaiTime due = time_of_sound(next_ + at_once);
        if (is_over_ || due > TaiClock::now() + most) {
            std::this_thread::sleep_for(most);
            return std::nullopt;
        }
        sleep_until(due);
        SoundBlock block{next_, decoder_.next(at_once)};
        is_over_ = block.count() < at_once;
        next_ = block.end();
        return block;
    }

  private:
    SoundDecoder decoder_;
    std::int64_t next_;
    bool is_over_ = false;
};

class LtcPort final : public ControlPort {
  public:
    LtcPort(const OutputUrl& url, const ControlBench& bench) : name_(url.shown), bench_(bench) {
        if (url.place.starts_with(device_scheme)) {
            url.require_options_of({"channels"});
            sound_ = std::make_unique<HeardDevice>(url);
        } else {
            url.require_options_of({});
            sound_ = std::make_unique<HeardFile>(url);
        }
    }

    void serve(std::chrono::milliseconds most) override {
        const std::optional<SoundBlock> sound = sound_->next(most);
        stats_.dropped = sound_->dropped();
        if (!sound) return;
        for (const LtcReading& reading : reader_.hear(*sound)) take(reading);
        if (stats_.malformed == reader_.malformed()) return;
        stats_.malformed = reader_.malformed();
        stats_.last_refusal = "linear time code that is none, or does not follow what came before";
    }

  private:
    void take(const LtcReading& reading) {
        ++stats_.obeyed;
        const SmpteCount count = count_of(reading);
        const double rate_hz =
            count.is_drop_frame ? 30000.0 / 1001 : static_cast<double>(count.numbers_a_second);
        // In its middle, since where a frame begins is heard to a few samples.
        const TaiTime middle = time_of_sound(reading.first) + from_s(0.5 / rate_hz);
        const std::optional<SmpteCode> house =
            SmpteCode::parse(TimecodeClock(rate_hz).at(middle, read_kernel_clock().tai_offset_s));
        const std::optional<std::int64_t> here = house ? count.frame_of(*house) : std::nullopt;
        const std::int64_t ahead = here ? count.between(*count.frame_of(reading.code), *here) : 0;
        bench_.ltc.put({reading.code.text(), ahead});
        stats_.told = reading.code.text() + ", " + words_of_ltc(ahead);
        tell(reading, ahead);
    }
    /// What stays, and is another difference than was told last.
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
    LtcReader reader_;
    int same_ = 0;
    std::int64_t last_ahead_ = 0;
    std::optional<std::int64_t> told_ahead_;
};

}  // namespace

PortEntry ltc_port_entry() {
    return {"ltc",
            "ltc://alsa:DEVICE (?channels=2) or ltc://FILE (linear time code, shown beside the "
            "house's)",
            [](const OutputUrl& url, const ControlBench& bench) {
                return std::make_unique<LtcPort>(url, bench);
            }};
}

}  // namespace vantage
