#include "host_app/sound/alsa_capture.h"

// ALSA's header does not declare C linkage for its error handlers.
extern "C" {
#include <alsa/asoundlib.h>
}

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "common/base/error.h"
#include "common/base/library_log.h"

namespace vantage {
namespace {

constexpr unsigned buffer_us = 500'000, period_us = 10'000;
constexpr std::size_t most_at_once = 4800;

/// Sample formats, best first.
constexpr std::array formats{SND_PCM_FORMAT_S32_LE, SND_PCM_FORMAT_FLOAT_LE, SND_PCM_FORMAT_S24_LE,
                             SND_PCM_FORMAT_S24_3LE, SND_PCM_FORMAT_S16_LE};

float value_of(const std::uint8_t* bytes, int format) {
    constexpr float whole = 1.0F / 2147483648.0F;
    const auto left_aligned = [&](int count) {
        std::uint32_t value = 0;
        for (int i = 0; i < count; ++i) value |= std::uint32_t{bytes[i]} << (32 - 8 * (count - i));
        return whole * static_cast<float>(static_cast<std::int32_t>(value));
    };
    switch (format) {
        case SND_PCM_FORMAT_FLOAT_LE: {
            float value = 0;
            std::memcpy(&value, bytes, sizeof value);
            return value;
        }
        case SND_PCM_FORMAT_S16_LE:
            return left_aligned(2);
        case SND_PCM_FORMAT_S24_LE:
        case SND_PCM_FORMAT_S24_3LE:
            return left_aligned(3);
        default:
            return left_aligned(4);
    }
}

/// Receives the messages that ALSA would print to stderr. Our own sentences name its errors.
void keep_alsa_message(const char*, int, const char* function, int, const char* format, ...) {
    static LibraryLog log("ALSA", LogLevel::debug);
    std::array<char, 512> text{};
    va_list words;
    va_start(words, format);
    std::vsnprintf(text.data(), text.size(), format, words);
    va_end(words);
    log.note(fmt::format("{}: {}", function ? function : "", text.data()));
}

/// An offset that clock drift cannot explain: samples were lost, or the device runs at full speed.
constexpr std::int64_t break_samples = sound_rate_hz / 4;
/// The average offset at which drift is corrected, over two seconds.
constexpr double mended_samples = sound_rate_hz / 1000.0;
constexpr double average_samples = 2.0 * sound_rate_hz;
/// At most 1 / mend_share of a block is inserted or removed.
constexpr std::int64_t mend_share = 400;

}  // namespace

void keep_alsa_log() { snd_lib_error_set_handler(keep_alsa_message); }

void AlsaCapture::Close::operator()(_snd_pcm* device) const { snd_pcm_close(device); }

AlsaCapture::AlsaCapture(const std::string& name, unsigned left, unsigned right) : name_(name) {
    keep_alsa_log();
    snd_pcm_t* device = nullptr;
    if (const int code =
            snd_pcm_open(&device, name.c_str(), SND_PCM_STREAM_CAPTURE, SND_PCM_NONBLOCK);
        code < 0)
        refuse("it cannot be opened", code);
    device_.reset(device);
    choose_format();
    if (std::max(left, right) > channels_)
        fail("the sound device {} has {} channels, but no channel {}", name, channels_,
             std::max(left, right));
    left_ = left == 0 ? 0 : left - 1;
    right_ = right == 0 ? std::min(channels_, 2U) - 1 : right - 1;
    AVChannelLayout stereo{};
    av_channel_layout_default(&stereo, static_cast<int>(sound_channels));
    if (rate_hz_ != sound_rate_hz)
        converter_.emplace(stereo, AV_SAMPLE_FMT_FLT, static_cast<int>(rate_hz_));
    raw_.resize(most_at_once * channels_ *
                static_cast<std::size_t>(
                    snd_pcm_format_physical_width(static_cast<snd_pcm_format_t>(format_)) / 8));
    if (const int code = snd_pcm_start(device); code < 0) refuse("it does not start", code);
}

AlsaCapture::~AlsaCapture() = default;

void AlsaCapture::choose_format() {
    snd_pcm_t* device = device_.get();
    snd_pcm_hw_params_t* request = nullptr;
    snd_pcm_hw_params_alloca(&request);
    int code = snd_pcm_hw_params_any(device, request);
    if (code >= 0)
        code = snd_pcm_hw_params_set_access(device, request, SND_PCM_ACCESS_RW_INTERLEAVED);
    if (code < 0) refuse("it supports no access mode", code);
    const auto format = std::find_if(formats.begin(), formats.end(), [&](snd_pcm_format_t each) {
        return snd_pcm_hw_params_set_format(device, request, each) == 0;
    });
    if (format == formats.end())
        fail("the sound device {} supports none of the sample formats with 16, 24 or 32 bits",
             name_);
    format_ = *format;
    rate_hz_ = sound_rate_hz;
    channels_ = sound_channels;
    unsigned buffer = buffer_us, period = period_us;
    snd_pcm_hw_params_set_rate_near(device, request, &rate_hz_, nullptr);
    snd_pcm_hw_params_set_channels_near(device, request, &channels_);
    snd_pcm_hw_params_set_buffer_time_near(device, request, &buffer, nullptr);
    snd_pcm_hw_params_set_period_time_near(device, request, &period, nullptr);
    if (code = snd_pcm_hw_params(device, request); code < 0)
        refuse("it refuses the settings", code);
}

AlsaCapture::Piece AlsaCapture::read(std::chrono::milliseconds most) {
    snd_pcm_t* device = device_.get();
    if (const int code = snd_pcm_wait(device, static_cast<int>(most.count())); code <= 0) {
        if (code < 0) recover(code);
        return {};
    }
    const snd_pcm_sframes_t frames = snd_pcm_readi(device, raw_.data(), most_at_once);
    if (frames == -EAGAIN || frames == 0) return {};
    if (frames < 0) {
        recover(static_cast<int>(frames));
        return {};
    }
    snd_pcm_sframes_t unread = 0;
    const TaiTime now = TaiClock::now();
    if (snd_pcm_delay(device, &unread) < 0) unread = 0;
    const auto width = static_cast<std::size_t>(
        snd_pcm_format_physical_width(static_cast<snd_pcm_format_t>(format_)) / 8);
    Piece piece;
    piece.heard_until = now - from_s(static_cast<double>(unread) / rate_hz_);
    const auto count = static_cast<std::size_t>(frames);
    piece.samples.resize(count * sound_channels);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t* frame = raw_.data() + i * channels_ * width;
        piece.samples[2 * i] = value_of(frame + left_ * width, format_);
        piece.samples[2 * i + 1] = value_of(frame + right_ * width, format_);
    }
    if (converter_) {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(piece.samples.data());
        piece.samples = converter_->convert(&bytes, static_cast<int>(frames));
    }
    return piece;
}

void AlsaCapture::recover(int code) {
    if (code == -EPIPE || code == -ESTRPIPE || code == -EINTR)
        code = snd_pcm_recover(device_.get(), code, 1);
    if (code >= 0) code = snd_pcm_start(device_.get());
    if (code < 0 && code != -EBADFD) refuse("it is gone", code);
}

void AlsaCapture::refuse(const char* what, int code) const {
    fail("the sound device {}: {} ({})", name_, what, snd_strerror(code));
}

SoundBlock SoundPlacer::place(std::span<const float> block, TaiTime heard_until) {
    const auto count = static_cast<std::int64_t>(block.size() / sound_channels);
    const std::int64_t end = sound_sample_at(heard_until);
    if (!next_) next_ = end - count;
    stats_.heard += static_cast<std::uint64_t>(count);
    const std::int64_t late = end - (*next_ + count);
    if (late < -break_samples) {
        stats_.dropped += static_cast<std::uint64_t>(count);
        return {*next_, {}};
    }
    if (late > break_samples) {
        stats_.lost += static_cast<std::uint64_t>(late);
        *next_ += late;
        late_ = 0;
    } else {
        late_ += (static_cast<double>(late) - late_) *
                 std::min(1.0, static_cast<double>(count) / average_samples);
    }
    std::int64_t mend = 0;
    if (std::abs(late_) > mended_samples) {
        mend = late_ > 0 ? 1 + count / mend_share : -1 - count / mend_share;
        late_ -= static_cast<double>(mend);
        (mend > 0 ? stats_.inserted : stats_.removed) += static_cast<std::uint64_t>(std::abs(mend));
    }
    SoundBlock placed{
        *next_,
        stretched(block, static_cast<std::size_t>(std::max<std::int64_t>(0, count + mend)))};
    *next_ = placed.end();
    return placed;
}

}  // namespace vantage
