#include <algorithm>
#include <atomic>
#include <mutex>

#include "common/base/log.h"
#include "host_app/sound/sound_source.h"

namespace vantage {
namespace {

/// Reads the sound of a take block by block. Not thread-safe.
class TakeSoundReading {
  public:
    explicit TakeSoundReading(std::shared_ptr<const TakeReader> take) : take_(std::move(take)) {}

    /// Copies samples; missing ones are silent. Returns the number of samples that the take has.
    std::size_t read(std::int64_t first, std::span<float> samples) {
        std::fill(samples.begin(), samples.end(), 0.0F);
        const std::int64_t end = first + static_cast<std::int64_t>(samples.size() / sound_channels);
        const std::vector<TakeReader::Sound>& sounds = take_->sounds();
        auto sound = std::partition_point(
            sounds.begin(), sounds.end(),
            [&](const TakeReader::Sound& each) { return each.end() <= first; });
        std::size_t there = 0;
        for (; sound != sounds.end() && sound->first < end; ++sound) {
            const std::vector<float>& stored = samples_of(*sound);
            const std::int64_t from = std::max(first, sound->first);
            const std::int64_t until = std::min(end, sound->end());
            if (stored.empty()) continue;
            std::copy(place(stored, from - sound->first), place(stored, until - sound->first),
                      samples.begin() + 2 * (from - first));
            there += static_cast<std::size_t>(until - from);
        }
        return there;
    }

  private:
    static std::vector<float>::const_iterator place(const std::vector<float>& samples,
                                                    std::int64_t sample) {
        return samples.begin() + static_cast<std::ptrdiff_t>(sound_channels) * sample;
    }
    /// The samples of a block; empty if it is damaged.
    const std::vector<float>& samples_of(const TakeReader::Sound& sound) {
        if (sound.first == kept_) return decoded_;
        kept_ = sound.first;
        decoded_.clear();
        try {
            decoded_ = sound_from_stored(take_->load(sound));
        } catch (const TakeDamaged& error) {
            if (!std::exchange(is_told_, true))
                log_warning("{}; vantage take check lists all damage", error.what());
        }
        return decoded_;
    }

    std::shared_ptr<const TakeReader> take_;
    std::int64_t kept_ = -1;
    std::vector<float> decoded_;
    bool is_told_ = false;
};

SoundState state_of(const TakeReader& take) {
    SoundState state;
    state.name = "take " + take.path().string();
    state.phase = SoundPhase::on;
    return state;
}

class TakeSound final : public SoundSource {
  public:
    TakeSound(std::shared_ptr<const TakeReader> take, TaiTime begin)
        : state_(state_of(*take)),
          ahead_(
              [reading = std::make_shared<TakeSoundReading>(std::move(take))](std::int64_t first,
                                                                              std::size_t count) {
                  std::vector<float> samples(count * sound_channels);
                  reading->read(first, samples);
                  return samples;
              },
              sound_sample_at(begin) - sound_rate_hz) {}
    std::size_t read(std::int64_t first, std::span<float> samples) override {
        return ahead_.read(first, samples);
    }
    SoundState state() const override {
        SoundState state = state_;
        const SoundAhead::State ahead = ahead_.state();
        state.heard = ahead.fetched;
        if (!ahead.failure.empty()) {
            state.phase = SoundPhase::failed;
            state.failure = ahead.failure;
            state.failures = 1;
        }
        return state;
    }

  private:
    SoundState state_;
    SoundAhead ahead_;
};

class PatientTakeSound final : public SoundSource {
  public:
    explicit PatientTakeSound(const std::shared_ptr<const TakeReader>& take)
        : state_(state_of(*take)), reading_(take) {}
    std::size_t read(std::int64_t first, std::span<float> samples) override {
        const std::lock_guard lock(mutex_);
        return reading_.read(first, samples);
    }
    SoundState state() const override { return state_; }

  private:
    SoundState state_;
    std::mutex mutex_;
    TakeSoundReading reading_;
};

}  // namespace

std::shared_ptr<SoundSource> open_take_sound(std::shared_ptr<const TakeReader> take,
                                             TaiTime begin) {
    return std::make_shared<TakeSound>(std::move(take), begin);
}

std::shared_ptr<SoundSource> open_patient_take_sound(std::shared_ptr<const TakeReader> take) {
    return std::make_shared<PatientTakeSound>(take);
}

}  // namespace vantage
