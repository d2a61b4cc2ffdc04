#include "host_app/output/media/sound_encoder.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"

namespace vantage {
namespace {

/// Converts -1..1 to 24 bits in the high bits of 32.
std::int32_t to_s32(float value) {
    constexpr float most = 8388607;
    const auto whole =
        static_cast<std::int32_t>(std::lround(std::clamp(value * (most + 1), -most - 1, most)));
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(whole) << 8);
}

}  // namespace

SoundEncoder::SoundEncoder(Codec codec, bool has_head) : frame_(av_frame_alloc()) {
    const char* name = codec == Codec::pcm ? "pcm_s24le" : "aac";
    const AVCodec* found = avcodec_find_encoder_by_name(name);
    if (!found) fail("sound cannot be encoded: FFmpeg has no encoder {} here", name);
    context_.reset(avcodec_alloc_context3(found));
    context_->sample_rate = sound_rate_hz;
    context_->time_base = {1, sound_rate_hz};
    av_channel_layout_default(&context_->ch_layout, static_cast<int>(sound_channels));
    context_->sample_fmt = codec == Codec::pcm ? AV_SAMPLE_FMT_S32 : AV_SAMPLE_FMT_FLTP;
    constexpr int aac_bps = 192'000;
    if (codec == Codec::aac) context_->bit_rate = aac_bps;
    if (has_head) context_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    if (const int code = avcodec_open2(context_.get(), found, nullptr); code < 0)
        fail("sound cannot be encoded by {} ({})", name, av_reason(code));
}

void SoundEncoder::add(std::span<const float> samples) {
    waiting_.insert(waiting_.end(), samples.begin(), samples.end());
    const auto whole = static_cast<std::size_t>(context_->frame_size);
    const auto there = [&] { return waiting_.size() / sound_channels; };
    while (there() > 0 && there() >= whole) send(whole > 0 ? whole : there());
}

void SoundEncoder::send(std::size_t count) {
    av_frame_unref(frame_.get());
    frame_->format = context_->sample_fmt;
    frame_->ch_layout = context_->ch_layout;
    frame_->sample_rate = sound_rate_hz;
    frame_->nb_samples = static_cast<int>(count);
    frame_->pts = sent_;
    if (av_frame_get_buffer(frame_.get(), 0) < 0) fail("memory is short");
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t channel = 0; channel < sound_channels; ++channel) {
            const float value = waiting_[i * sound_channels + channel];
            if (context_->sample_fmt == AV_SAMPLE_FMT_S32)
                reinterpret_cast<std::int32_t*>(frame_->data[0])[i * sound_channels + channel] =
                    to_s32(value);
            else
                reinterpret_cast<float*>(frame_->data[channel])[i] = value;
        }
    waiting_.erase(waiting_.begin(),
                   waiting_.begin() + static_cast<std::ptrdiff_t>(count * sound_channels));
    sent_ += static_cast<std::int64_t>(count);
    if (const int code = avcodec_send_frame(context_.get(), frame_.get()); code < 0)
        fail("the encoder {} takes no sound ({})", context_->codec->name, av_reason(code));
    drain();
}

void SoundEncoder::drain() {
    for (;;) {
        AvPacketPtr packet(av_packet_alloc());
        const int code = avcodec_receive_packet(context_.get(), packet.get());
        if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return;
        if (code < 0) fail("the encoder {} fails ({})", context_->codec->name, av_reason(code));
        done_.push_back(std::move(packet));
    }
}

void SoundEncoder::end() {
    if (!waiting_.empty()) send(waiting_.size() / sound_channels);
    avcodec_send_frame(context_.get(), nullptr);
    drain();
}

AVPacket* SoundEncoder::next() {
    if (done_.empty()) return nullptr;
    given_ = std::move(done_.front());
    done_.pop_front();
    return given_.get();
}

void SoundTrack::add(const SoundBlock& block, std::int64_t tick) {
    if (!has_begun_) {
        has_begun_ = true;
        next_ = block.first - grid_.first_of(tick);
    }
    if (block.first > next_) {
        const std::vector<float> silence(static_cast<std::size_t>(block.first - next_) *
                                         sound_channels);
        encoder_.add(silence);
    }
    encoder_.add(block.samples);
    next_ = block.end();
}

}  // namespace vantage
