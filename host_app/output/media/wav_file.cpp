#include "host_app/output/media/wav_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <unistd.h>

#include "common/av/av_log.h"
#include "common/base/error.h"

namespace vantage {

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

}  // namespace vantage
