#include "host_app/sound/picture_sound.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace vantage {
namespace {

/// The largest offset that is corrected by stretching; at 0.5 % that takes 20 s. A larger offset is
/// a jump.
constexpr std::int64_t longest_slide = sound_rate_hz / 10;
/// At most 1 / slide_share of a tick's samples is inserted or removed: 0.09 semitones.
constexpr std::int64_t slide_share = 200;
/// The limit for a take's sound, so that it has no gap when the pictures' delay falls by half a
/// second at the begin of a show.
constexpr std::int64_t longest_tap_slide = sound_rate_hz;
/// Offsets up to 5 ms are not corrected: nobody hears them.
constexpr std::int64_t unheard = sound_rate_hz / 200;
/// Delays measured before a take's sound begins, since the first picture is late.
constexpr std::size_t fewest_latencies = 3;
/// The crossfade between silence and sound, or between two pieces of sound: 5 ms.
constexpr std::size_t fade_samples = sound_rate_hz / 200;

/// Crossfades from `from`, if any, to `samples`.
void fade_over(std::vector<float>& samples, std::span<const float> from) {
    const std::size_t length = std::min(fade_samples, samples.size() / sound_channels);
    for (std::size_t i = 0; i < length; ++i) {
        const float share = static_cast<float>(i) / static_cast<float>(length);
        for (std::size_t channel = 0; channel < sound_channels; ++channel) {
            const std::size_t at = i * sound_channels + channel;
            const float before = at < from.size() ? from[at] : 0;
            samples[at] = share * samples[at] + (1 - share) * before;
        }
    }
}

/// By how many samples a tick of `count` is stretched to reduce the offset `off`.
std::int64_t slide_towards(std::int64_t off, std::int64_t count) {
    const std::int64_t most = std::max<std::int64_t>(1, count / slide_share);
    return std::clamp(off, -most, most);
}

/// The decay of the level meter: that of peak programme meters (IEC 60268-10: 20 dB in 1.7 s).
constexpr double fall_db_s = 12;
constexpr double silent_dbfs = -120;

/// The peak level in dB full scale.
double peak_dbfs(std::span<const float> samples, double least) {
    float most = 0;
    for (const float value : samples) most = std::max(most, std::abs(value));
    return std::max(
        {most > 0 ? 20 * std::log10(static_cast<double>(most)) : silent_dbfs, least, silent_dbfs});
}

}  // namespace

PictureSound::PictureSound(const Settings& settings, std::shared_ptr<SoundSource> source)
    : settings_(settings), source_(std::move(source)), grid_(settings.rate_hz) {}

std::chrono::nanoseconds PictureSound::delay(const Tick& tick) const {
    if (settings_.delay) return *settings_.delay;
    if (source_->goes_with_ticks()) return {};
    return tick.shown_time == tick.now ? live_.now() : past_.now();
}

std::optional<std::int64_t> PictureSound::wanted(const Tick& tick, std::int64_t first) const {
    const std::int64_t delay_samples =
        (delay(tick).count() * sound_rate_hz + nanoseconds_per_second / 2) / nanoseconds_per_second;
    if (source_->goes_with_ticks()) return first - delay_samples;
    if (!tick.shown_time) return std::nullopt;
    // Time that does not advance at normal speed, led by a flight or a jump, is silent.
    const double period_ns = static_cast<double>(nanoseconds_per_second) / settings_.rate_hz;
    constexpr double even = 0.05;
    if (last_time_ && std::abs(static_cast<double>((*tick.shown_time - *last_time_).count()) -
                               period_ns) > even * period_ns)
        return std::nullopt;
    return sound_sample_at(*tick.shown_time) - delay_samples;
}

std::shared_ptr<const SoundBlock> PictureSound::next(const Tick& tick) {
    const bool is_first = tick_ == 0;
    auto block = std::make_shared<SoundBlock>();
    block->first = grid_.first_of(tick_);
    const std::int64_t count = grid_.first_of(++tick_) - block->first;
    const auto read = [this](std::int64_t first, std::int64_t samples, std::size_t* missing) {
        std::vector<float> sound(static_cast<std::size_t>(samples) * sound_channels);
        const std::size_t there = source_->read(first, sound);
        if (missing) *missing += static_cast<std::size_t>(samples) - there;
        return sound;
    };
    const std::optional<std::int64_t> from = wanted(tick, block->first);
    last_time_ = tick.shown_time;
    const std::vector<float> before =
        position_ ? read(*position_, fade_samples, nullptr) : std::vector<float>();
    const bool jumps = from && position_ && std::abs(*from - *position_) > longest_slide;
    std::size_t missing = 0;
    std::int64_t slide = 0;
    if (!from) {
        block->samples.resize(static_cast<std::size_t>(count) * sound_channels);
        fade_over(block->samples, before);
        position_.reset();
    } else if (position_ && !jumps) {
        slide = slide_towards(*from - *position_, count);
        block->samples =
            stretched(read(*position_, count + slide, &missing), static_cast<std::size_t>(count));
        *position_ += count + slide;
    } else {
        block->samples = read(*from, count, &missing);
        if (!is_first) fade_over(block->samples, before);
        position_ = *from + count;
    }
    give_to_tap(tick, *block);
    const std::lock_guard lock(mutex_);
    told_.delay_ms = to_ms(delay(tick));
    told_.peak_dbfs = peak_dbfs(block->samples, told_.peak_dbfs - fall_db_s / settings_.rate_hz);
    told_.jumps += jumps;
    told_.slid += static_cast<std::uint64_t>(std::abs(slide));
    told_.played += from ? static_cast<std::uint64_t>(count) : 0;
    told_.missing += missing;
    return block;
}

void PictureSound::give_to_tap(const Tick& tick, const SoundBlock& block) {
    if (!settings_.tap || !source_->goes_with_ticks() || live_.seen() < fewest_latencies) return;
    const std::int64_t heard = sound_sample_at(tick.now - live_.now());
    if (!tapped_ || std::abs(heard - *tapped_) > longest_tap_slide) tapped_ = heard;
    const std::int64_t off = heard - *tapped_;
    const std::int64_t slide = std::abs(off) > unheard ? slide_towards(off, block.count()) : 0;
    const auto count = static_cast<std::size_t>(block.count() + slide);
    settings_.tap({*tapped_, slide ? stretched(block.samples, count) : block.samples});
    *tapped_ += static_cast<std::int64_t>(count);
}

SoundState PictureSound::state() const {
    SoundState state = source_->state();
    const std::lock_guard lock(mutex_);
    state.delay_ms = told_.delay_ms;
    state.peak_dbfs = told_.peak_dbfs;
    state.played = told_.played;
    state.missing = told_.missing;
    state.slid = told_.slid;
    state.jumps = told_.jumps;
    return state;
}

}  // namespace vantage
