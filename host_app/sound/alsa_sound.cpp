#include <atomic>
#include <charconv>
#include <mutex>
#include <thread>

#include "common/base/error.h"
#include "common/base/log.h"
#include "host_app/output/output_url.h"
#include "host_app/sound/alsa_capture.h"
#include "host_app/sound/sound_source.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// Sound kept for replays: 60 s, 23 MB.
constexpr std::size_t kept_samples = 60 * static_cast<std::size_t>(sound_rate_hz);
constexpr std::chrono::milliseconds device_look{50}, device_rest{1000}, longest_sleep{200};

struct ChannelPair {
    unsigned left = 0, right = 0;
};

/// Parses "3,4" or "3".
ChannelPair channels_of(const OutputUrl& url) {
    url.require_options_of({"channels"});
    const std::optional<std::string> text = url.option("channels");
    if (!text) return {};
    ChannelPair pair;
    const char* const end = text->data() + text->size();
    constexpr unsigned most = 256;
    auto [at, error] = std::from_chars(text->data(), end, pair.left);
    pair.right = pair.left;
    if (error == std::errc() && at != end && *at == ',') {
        const auto second = std::from_chars(at + 1, end, pair.right);
        at = second.ptr;
        error = second.ec;
    }
    if (error != std::errc() || at != end || pair.left < 1 || pair.right < 1 ||
        std::max(pair.left, pair.right) > most)
        fail("the {} {}: give one or two channels from 1 to {}, such as channels=3,4", url.kind,
             url.shown, most);
    return pair;
}

class AlsaSound final : public SoundSource {
  public:
    AlsaSound(const OutputUrl& url, SoundTap tap)
        : name_(url.place), channels_(channels_of(url)), tap_(std::move(tap)), ring_(kept_samples) {
        state_.name = url.shown;
        thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
    }

    std::size_t read(std::int64_t first, std::span<float> samples) override {
        return ring_.read(first, samples);
    }
    SoundState state() const override {
        const std::lock_guard lock(mutex_);
        return state_;
    }

  private:
    void run(const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            try {
                AlsaCapture device(name_, channels_.left, channels_.right);
                log_info("{}: on", state_.name);
                set_phase(SoundPhase::on, "");
                while (!stop.stop_requested()) take(device.read(device_look));
            } catch (const Error& error) {
                note_failure(error.what());
                for (auto waited = 0ms; waited < device_rest && !stop.stop_requested();
                     waited += device_look)
                    std::this_thread::sleep_for(device_look);
            }
        }
    }
    void take(const AlsaCapture::Piece& piece) {
        if (piece.samples.empty()) return;
        const SoundBlock block = placer_.place(piece.samples, piece.heard_until);
        if (!block.samples.empty()) {
            ring_.write(block.first, block.samples);
            if (tap_) tap_(block);
        }
        {
            const SoundPlacer::Stats& stats = placer_.stats();
            const std::lock_guard lock(mutex_);
            state_.heard = stats.heard;
            state_.lost = stats.lost;
            state_.dropped = stats.dropped;
            state_.inserted = stats.inserted;
            state_.removed = stats.removed;
            state_.drift_ppm = stats.drift_ppm();
        }
        // Virtual devices such as ALSA's null plugin deliver as fast as they are read.
        const std::chrono::nanoseconds early =
            time_of_sound(block.end()) - TaiClock::now() - device_look / 5;
        if (early > 0ns)
            std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(early, longest_sleep));
    }
    void set_phase(SoundPhase phase, const std::string& failure) {
        const std::lock_guard lock(mutex_);
        state_.phase = phase;
        state_.failure = failure;
    }
    void note_failure(const std::string& sentence) {
        {
            const std::lock_guard lock(mutex_);
            if (state_.failure == sentence) return;
            ++state_.failures;
        }
        log_error("{}; the programme continues without sound until the device is back", sentence);
        set_phase(SoundPhase::failed, sentence);
    }

    std::string name_;
    ChannelPair channels_;
    SoundTap tap_;
    SoundRing ring_;
    SoundPlacer placer_;  ///< used by the thread only
    mutable std::mutex mutex_;
    SoundState state_;
    std::jthread thread_;
};

}  // namespace

std::shared_ptr<SoundSource> open_alsa_sound(const OutputUrl& url, SoundTap tap) {
    return std::make_shared<AlsaSound>(url, std::move(tap));
}

void check_alsa_sound(const OutputUrl& url) { (void)channels_of(url); }

}  // namespace vantage
