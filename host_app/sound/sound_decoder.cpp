#include "host_app/sound/sound_decoder.h"

#include <algorithm>

#include "common/av/av_input.h"
#include "common/base/error.h"

namespace vantage {

SoundDecoder::SoundDecoder(std::filesystem::path path)
    : path_(std::move(path)), packet_(av_packet_alloc()), frame_(av_frame_alloc()) {
    int code = 0;
    input_ = open_av_input(path_, code);
    if (!input_) refuse(code);
    const AVCodec* codec = nullptr;
    code = find_av_stream(*input_, AVMEDIA_TYPE_AUDIO, &codec);
    if (code < 0 || !codec) fail("{} has no sound that FFmpeg can decode", path_.string());
    stream_ = input_->streams[code];
    constexpr int threads = 1;
    code = open_av_decoder(*stream_, *codec, threads, decoder_);
    if (code < 0) refuse(code);
}

SoundDecoder SoundDecoder::as_stored(std::filesystem::path path) {
    SoundDecoder decoder(std::move(path));
    decoder.is_as_stored_ = true;
    if (decoder.rate_hz() <= 0 || decoder.channels() == 0)
        fail("the sound of {} states neither its rate nor its channels", decoder.path_.string());
    return decoder;
}

std::vector<float> SoundDecoder::next(std::size_t count) {
    const std::size_t values = count * channels();
    while (decoded_.size() < values && !is_at_end_) decode_some();
    const auto end =
        decoded_.begin() + static_cast<std::ptrdiff_t>(std::min(values, decoded_.size()));
    std::vector<float> samples(decoded_.begin(), end);
    decoded_.erase(decoded_.begin(), end);
    return samples;
}

void SoundDecoder::decode_some() {
    const int code = av_read_frame(input_.get(), packet_.get());
    if (code == AVERROR_EOF) {
        is_at_end_ = true;
        avcodec_send_packet(decoder_.get(), nullptr);
        take_frames();
        if (!converter_) return;
        const std::vector<float> rest = converter_->rest();
        decoded_.insert(decoded_.end(), rest.begin(), rest.end());
        return;
    }
    if (code < 0) refuse(code);
    // A damaged packet is skipped, and decoding continues after it.
    if (packet_->stream_index == stream_->index) avcodec_send_packet(decoder_.get(), packet_.get());
    av_packet_unref(packet_.get());
    take_frames();
}

void SoundDecoder::take_frames() {
    while (avcodec_receive_frame(decoder_.get(), frame_.get()) >= 0) {
        if (!converter_) {
            AVChannelLayout channels = frame_->ch_layout;
            if (channels.order == AV_CHANNEL_ORDER_UNSPEC)
                av_channel_layout_default(&channels, channels.nb_channels);
            const auto format = static_cast<AVSampleFormat>(frame_->format);
            converter_ = is_as_stored_
                             ? SoundConverter::of_format(channels, format, frame_->sample_rate)
                             : SoundConverter(channels, format, frame_->sample_rate);
        }
        const std::vector<float> samples =
            converter_->convert(frame_->extended_data, frame_->nb_samples);
        decoded_.insert(decoded_.end(), samples.begin(), samples.end());
    }
}

void SoundDecoder::refuse(int code) const {
    fail("the sound of {} cannot be read: {}", path_.string(), av_reason(code));
}

namespace {

AVChannelLayout stereo_layout() {
    AVChannelLayout stereo{};
    av_channel_layout_default(&stereo, static_cast<int>(sound_channels));
    return stereo;
}

}  // namespace

SoundConverter::SoundConverter(AVChannelLayout channels, AVSampleFormat format, int rate_hz)
    : SoundConverter(channels, format, rate_hz, stereo_layout(), sound_rate_hz) {}

SoundConverter SoundConverter::of_format(AVChannelLayout channels, AVSampleFormat format,
                                         int rate_hz) {
    return {channels, format, rate_hz, channels, rate_hz};
}

SoundConverter::SoundConverter(AVChannelLayout from, AVSampleFormat format, int from_hz,
                               AVChannelLayout to, int to_hz)
    : channels_(static_cast<std::size_t>(to.nb_channels)) {
    SwrContext* context = nullptr;
    int code = swr_alloc_set_opts2(&context, &to, AV_SAMPLE_FMT_FLT, to_hz, &from, format, from_hz,
                                   0, nullptr);
    context_.reset(context);
    if (code >= 0) code = swr_init(context);
    if (code < 0)
        fail("sound of {} channels at {} Hz cannot be converted ({})", from.nb_channels, from_hz,
             av_reason(code));
}

std::vector<float> SoundConverter::convert(const std::uint8_t* const* planes, int count) {
    const int most = swr_get_out_samples(context_.get(), count);
    std::vector<float> samples(static_cast<std::size_t>(std::max(0, most)) * channels_);
    auto* out = reinterpret_cast<std::uint8_t*>(samples.data());
    const int made =
        swr_convert(context_.get(), &out, most, const_cast<const std::uint8_t**>(planes), count);
    if (made < 0) fail("sound cannot be converted ({})", av_reason(made));
    samples.resize(static_cast<std::size_t>(made) * channels_);
    return samples;
}

}  // namespace vantage
