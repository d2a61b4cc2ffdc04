#include "host_app/output/media/alsa_playback.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>

// The header declares the error handlers without C linkage.
extern "C" {
#include <alsa/asoundlib.h>
}

#include "common/av/sound.h"
#include "common/base/error.h"

namespace vantage {
namespace {

/// Target of the device's buffer in samples: 0.1 s covers jitter of the programme.
constexpr std::int64_t waiting_samples = sound_rate_hz / 10;
constexpr unsigned playback_buffer_us = 500'000, playback_period_us = 10'000;

}  // namespace

void AlsaPlayback::Inpainting::operator()(_snd_pcm* device) const { snd_pcm_close(device); }

AlsaPlayback::AlsaPlayback(const std::string& name) : name_(name) {
    snd_lib_error_set_local([](const char*, int, const char*, int, const char*, va_list) {});
    snd_pcm_t* device = nullptr;
    int code = snd_pcm_open(&device, name.c_str(), SND_PCM_STREAM_PLAYBACK, SND_PCM_NONBLOCK);
    if (code < 0) refuse("it cannot be opened", code);
    device_.reset(device);
    snd_pcm_hw_params_t* request = nullptr;
    snd_pcm_hw_params_alloca(&request);
    code = snd_pcm_hw_params_any(device, request);
    if (code >= 0)
        code = snd_pcm_hw_params_set_access(device, request, SND_PCM_ACCESS_RW_INTERLEAVED);
    if (code >= 0) code = snd_pcm_hw_params_set_format(device, request, SND_PCM_FORMAT_S16_LE);
    if (code >= 0) code = snd_pcm_hw_params_set_rate(device, request, sound_rate_hz, 0);
    unsigned buffer = playback_buffer_us, period = playback_period_us;
    if (code >= 0) code = snd_pcm_hw_params_set_channels_near(device, request, &channels_);
    if (code >= 0) snd_pcm_hw_params_set_buffer_time_near(device, request, &buffer, nullptr);
    if (code >= 0) snd_pcm_hw_params_set_period_time_near(device, request, &period, nullptr);
    if (code >= 0) code = snd_pcm_hw_params(device, request);
    if (code < 0) refuse("it plays no 16 bits at 48000 Hz; plughw: instead of hw: may", code);
    fill_up();
}

AlsaPlayback::~AlsaPlayback() = default;

void AlsaPlayback::fill_up() {
    raw_.assign(static_cast<std::size_t>(waiting_samples) * channels_, 0);
    const snd_pcm_sframes_t written = snd_pcm_writei(device_.get(), raw_.data(), waiting_samples);
    if (written < 0) refuse("it plays nothing", static_cast<int>(written));
}

bool AlsaPlayback::play(std::span<const float> samples) {
    snd_pcm_t* device = device_.get();
    snd_pcm_sframes_t waiting = 0;
    if (const int code = snd_pcm_delay(device, &waiting); code < 0) {
        if (code != -EPIPE) refuse("it is gone", code);
        ++underruns_;
        if (const int again = snd_pcm_recover(device, code, 1); again < 0)
            refuse("it is gone", again);
        fill_up();
        waiting = waiting_samples;
    }
    if (const snd_pcm_sframes_t room = snd_pcm_avail_update(device);
        room >= 0 && room < static_cast<snd_pcm_sframes_t>(samples.size() + samples.size() / 100))
        return false;
    std::vector<float> both;
    for (const float sample : samples) both.insert(both.end(), sound_channels, sample);
    // Clock drift between programme and device slowly fills or empties the buffer.
    const auto count = static_cast<std::int64_t>(samples.size());
    const std::int64_t off = waiting_samples - static_cast<std::int64_t>(waiting);
    const std::int64_t mend = std::abs(off) < waiting_samples / 4
                                  ? 0
                                  : std::clamp<std::int64_t>(off, -count / 200, count / 200);
    const std::vector<float> fitted = stretched(both, static_cast<std::size_t>(count + mend));
    raw_.clear();
    constexpr float most = 32767;
    for (std::size_t i = 0; i < fitted.size(); i += sound_channels)
        raw_.insert(raw_.end(), channels_,
                    static_cast<std::int16_t>(std::lround(most * fitted[i])));
    const snd_pcm_sframes_t written =
        snd_pcm_writei(device, raw_.data(), static_cast<snd_pcm_uframes_t>(count + mend));
    if (written < 0 && written != -EAGAIN && written != -EPIPE)
        refuse("it is gone", static_cast<int>(written));
    return true;
}

void AlsaPlayback::refuse(const char* what, int code) const {
    fail("the sound device {}: {} ({})", name_, what, snd_strerror(code));
}

}  // namespace vantage
