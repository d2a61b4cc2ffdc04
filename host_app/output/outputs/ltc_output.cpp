// The header declares the error handlers without C linkage.
extern "C" {
#include <alsa/asoundlib.h>
}

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "common/av/av_handles.h"
#include "common/av/av_log.h"
#include "common/av/sound.h"
#include "common/base/error.h"
#include "common/base/files/output_path.h"
#include "common/base/time/pulse_grid.h"
#include "host_app/ltc/ltc_sound.h"
#include "host_app/output/output_target.h"

namespace vantage {
namespace {

/// Writer of a WAV file with one channel of 16 bits at 48 kHz. The file gets its final name once it
/// is complete.
class WavFile {
  public:
    /// Throws Error if it cannot be written.
    explicit WavFile(std::filesystem::path path);
    ~WavFile();
    WavFile(const WavFile&) = delete;
    WavFile& operator=(const WavFile&) = delete;

    /// Throws Error if the disk fails.
    void add(std::span<const float> samples);
    void finish();
    std::uint64_t bytes() const;

  private:
    [[noreturn]] void fail_writing(int code) const;

    std::filesystem::path path_, partial_;
    AvOutputPtr output_;
    AvPacketPtr packet_;
    std::int64_t samples_ = 0;
    bool is_finished_ = false;
};

WavFile::WavFile(std::filesystem::path path)
    : path_(std::move(path)),
      partial_(path_.string() + fmt::format(".partial-{}", getpid())),
      packet_(av_packet_alloc()) {
    keep_av_log();
    AVFormatContext* output = nullptr;
    int code = avformat_alloc_output_context2(&output, nullptr, "wav", partial_.c_str());
    if (code < 0) fail_writing(code);
    output_.reset(output);
    AVStream* stream = avformat_new_stream(output, nullptr);
    if (!stream) fail("memory is short");
    AVCodecParameters& parameters = *stream->codecpar;
    parameters.codec_type = AVMEDIA_TYPE_AUDIO;
    parameters.codec_id = AV_CODEC_ID_PCM_S16LE;
    parameters.sample_rate = sound_rate_hz;
    parameters.bits_per_coded_sample = 16;
    parameters.block_align = 2;
    av_channel_layout_default(&parameters.ch_layout, 1);
    stream->time_base = {1, sound_rate_hz};
    code = avio_open(&output->pb, ("file:" + partial_.string()).c_str(), AVIO_FLAG_WRITE);
    if (code >= 0) code = avformat_write_header(output, nullptr);
    if (code < 0) fail_writing(code);
}

WavFile::~WavFile() {
    if (is_finished_) return;
    output_.reset();
    std::error_code ignored;
    std::filesystem::remove(partial_, ignored);
}

void WavFile::add(std::span<const float> samples) {
    if (av_new_packet(packet_.get(), static_cast<int>(2 * samples.size())) < 0)
        fail("memory is short");
    for (std::size_t i = 0; i < samples.size(); ++i) {
        constexpr float most = 32767;
        const auto value = static_cast<std::uint16_t>(
            static_cast<std::int16_t>(std::lround(std::clamp(most * samples[i], -most, most))));
        packet_->data[2 * i] = static_cast<std::uint8_t>(value);
        packet_->data[2 * i + 1] = static_cast<std::uint8_t>(value >> 8);
    }
    packet_->pts = packet_->dts = samples_;
    samples_ += static_cast<std::int64_t>(samples.size());
    const int code = av_write_frame(output_.get(), packet_.get());
    av_packet_unref(packet_.get());
    if (code < 0) fail_writing(code);
}

void WavFile::finish() {
    if (const int code = av_write_trailer(output_.get()); code < 0) fail_writing(code);
    if (const int code = avio_closep(&output_->pb); code < 0) fail_writing(code);
    std::error_code error;
    std::filesystem::rename(partial_, path_, error);
    if (error) fail("cannot write {}: {}", path_.string(), error.message());
    is_finished_ = true;
}

std::uint64_t WavFile::bytes() const {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(0, avio_tell(output_->pb)));
}

void WavFile::fail_writing(int code) const {
    fail("cannot write {}: {}", path_.string(), av_reason(code));
}

/// Plays one channel of sound at 48 kHz on all channels of an ALSA device. The device has its own
/// clock: drift is corrected by stretching the sound by at most 0.5 percent.
class AlsaPlayback {
  public:
    /// Throws Error if the device cannot be opened or needs another rate.
    explicit AlsaPlayback(const std::string& name);
    ~AlsaPlayback();
    AlsaPlayback(const AlsaPlayback&) = delete;
    AlsaPlayback& operator=(const AlsaPlayback&) = delete;

    /// Returns false if the device's buffer is full. Throws Error if the device is gone.
    bool play(std::span<const float> samples);
    /// Number of times that the buffer ran empty.
    std::uint64_t underruns() const { return underruns_; }

  private:
    struct Close {
        void operator()(snd_pcm_t* device) const;
    };
    void fill_up();
    [[noreturn]] void refuse(const char* what, int code) const;

    std::string name_;
    std::unique_ptr<snd_pcm_t, Close> device_;
    unsigned channels_ = 2;
    std::vector<std::int16_t> raw_;
    std::uint64_t underruns_ = 0;
};

/// Target of the device's buffer in samples: 0.1 s covers jitter of the programme.
constexpr std::int64_t waiting_samples = sound_rate_hz / 10;
constexpr unsigned playback_buffer_us = 500'000, playback_period_us = 10'000;

void AlsaPlayback::Close::operator()(snd_pcm_t* device) const { snd_pcm_close(device); }

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
