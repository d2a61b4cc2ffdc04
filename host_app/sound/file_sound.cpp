#include <algorithm>
#include <filesystem>
#include <utility>

#include "host_app/output/output_url.h"
#include "host_app/sound/sound_decoder.h"
#include "host_app/sound/sound_source.h"

namespace vantage {
namespace {

/// Reads a sound file from its beginning, once or in a loop.
class FileReading {
  public:
    FileReading(std::filesystem::path path, bool loops)
        : path_(std::move(path)), loops_(loops), decoder_(std::in_place, path_) {}

    std::vector<float> fetch(std::int64_t first, std::size_t count) {
        if (first < next_) {
            decoder_.emplace(path_);
            next_ = 0;
        }
        if (first > next_) (void)take(static_cast<std::size_t>(first - next_));
        return take(count);
    }

  private:
    std::vector<float> take(std::size_t count) {
        std::vector<float> samples = decoder_->next(count);
        while (loops_ && samples.size() < count * sound_channels) {
            decoder_.emplace(path_);
            const std::vector<float> more = decoder_->next(count - samples.size() / sound_channels);
            if (more.empty()) break;
            samples.insert(samples.end(), more.begin(), more.end());
        }
        next_ += static_cast<std::int64_t>(samples.size() / sound_channels);
        return samples;
    }

    std::filesystem::path path_;
    bool loops_;
    std::optional<SoundDecoder> decoder_;
    std::int64_t next_ = 0;
};

class FileSound final : public SoundSource {
  public:
    FileSound(std::string name, const std::filesystem::path& path, bool loops)
        : name_(std::move(name)),
          ahead_(
              [reading = std::make_shared<FileReading>(path, loops)](
                  std::int64_t first, std::size_t count) { return reading->fetch(first, count); },
              0) {}

    std::size_t read(std::int64_t first, std::span<float> samples) override {
        // Silence before the beginning and after the end does not count as missing.
        const auto count = static_cast<std::int64_t>(samples.size() / sound_channels);
        const std::int64_t early = std::clamp<std::int64_t>(-first, 0, count);
        const auto silent = static_cast<std::size_t>(early);
        std::fill_n(samples.begin(), silent * sound_channels, 0.0F);
        if (early == count) return silent;
        const std::size_t there =
            silent + ahead_.read(first + early, samples.subspan(silent * sound_channels));
        return ahead_.state().is_at_end ? static_cast<std::size_t>(count) : there;
    }
    bool goes_with_ticks() const override { return true; }
    SoundState state() const override {
        const SoundAhead::State ahead = ahead_.state();
        SoundState state;
        state.name = name_;
        state.phase = !ahead.failure.empty() ? SoundPhase::failed
                      : ahead.is_at_end      ? SoundPhase::ended
                                             : SoundPhase::on;
        state.failure = ahead.failure;
        state.failures = ahead.failure.empty() ? 0 : 1;
        state.heard = ahead.fetched;
        return state;
    }

  private:
    std::string name_;
    SoundAhead ahead_;
};

}  // namespace

std::shared_ptr<SoundSource> open_file_sound(const OutputUrl& url) {
    url.require_options_of({"loop"});
    return std::make_shared<FileSound>("file " + url.shown, url.place,
                                       url.choice("loop", {"no", "yes"}) == "yes");
}

}  // namespace vantage
