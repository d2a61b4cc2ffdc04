#include "host_app/output/stream_target.h"

#include <algorithm>
#include <cmath>

#include "common/av/av_log.h"
#include "common/base/error.h"

extern "C" {
#include <libavutil/opt.h>
}

namespace vantage {
namespace {

struct AvDictionary {
    ~AvDictionary() { av_dict_free(&entries); }
    AVDictionary* entries = nullptr;
};

[[noreturn]] void fail_for(const char* what, int code, const std::string& hint = {}) {
    const std::string remark = take_av_remark();
    fail("{}: {}{}{}", what, remark.empty() ? av_reason(code) : remark, hint.empty() ? "" : "; ",
         hint);
}

int is_over(void* patience) { return static_cast<const OutputPatience*>(patience)->is_over(); }

}  // namespace

StreamTarget::StreamTarget(const Settings& settings, const OutputPatience& patience)
    : is_listening_(settings.is_listening) {
    keep_av_log();
    (void)take_av_remark();
    avformat_network_init();
    AVFormatContext* output = nullptr;
    if (const int code =
            avformat_alloc_output_context2(&output, nullptr, "mpegts", settings.url.c_str());
        code < 0)
        fail_for("it cannot be opened", code);
    output_.reset(output);
    output_->interrupt_callback = {is_over, const_cast<OutputPatience*>(&patience)};
    // Each packet is sent at once.
    output_->flags |= AVFMT_FLAG_FLUSH_PACKETS;
    // Sound arrives two AAC frames after its picture. Receivers that follow the stream's clock are
    // told to wait for it: libavformat's clock lags by twice this time.
    constexpr int sound_lag_us = 50'000;
    output_->max_delay = settings.has_sound ? sound_lag_us : 0;
    AvDictionary options;
    for (const auto& [name, value] : settings.options)
        av_dict_set(&options.entries, name.c_str(), value.c_str(), 0);
    if (const int code = avio_open2(&output_->pb, settings.url.c_str(), AVIO_FLAG_WRITE,
                                    &output_->interrupt_callback, &options.entries);
        code < 0)
        fail_for("it cannot be opened", code, settings.silence);
    encoder_.emplace(settings.encoder);
    packet_.reset(av_packet_alloc());
    if (!packet_) fail("memory is short");
    stream_ = &add_stream(encoder_->parameters(), encoder_->time_base());
    stream_->avg_frame_rate = encoder_->rate();
    if (settings.has_sound) {
        sound_.emplace(settings.encoder->settings().rate_hz, SoundEncoder::Codec::aac, false);
        const AVCodecContext& sound = sound_->encoder().context();
        const AvCodecParametersPtr parameters(avcodec_parameters_alloc());
        if (!parameters || avcodec_parameters_from_context(parameters.get(), &sound) < 0)
            fail("memory is short");
        sound_stream_ = &add_stream(*parameters, sound.time_base);
        av_opt_set_int(output_->priv_data, "pes_payload_size", 0, 0);
    }
    av_dict_set(&output_->metadata, "service_name", "Vantage", 0);
    if (const int code = avformat_write_header(output_.get(), nullptr); code < 0)
        fail_for_peer("it cannot be opened", code);
}

void StreamTarget::fail_for_peer(const char* what, int code) const {
    if (!is_listening_) fail_for(what, code);
    (void)take_av_remark();
    throw CallerLeft("its caller has left");
}

void StreamTarget::write_encoded(const EncodedPicture& picture, std::int64_t tick) {
    av_packet_unref(packet_.get());
    if (av_packet_ref(packet_.get(), picture.packet.get()) < 0) fail("memory is short");
    // The encoder counts the ticks of the programme, and a stream those since its beginning.
    const std::int64_t decoded_before = packet_->pts - packet_->dts;
    packet_->pts = tick;
    packet_->dts = tick - decoded_before;
    mux(*packet_, encoder_->time_base(), *stream_);
}

AVStream& StreamTarget::add_stream(const AVCodecParameters& parameters, AVRational time_base) {
    AVStream* stream = avformat_new_stream(output_.get(), nullptr);
    if (!stream) fail("memory is short");
    stream->time_base = time_base;
    if (avcodec_parameters_copy(stream->codecpar, &parameters) < 0) fail("memory is short");
    return *stream;
}

void StreamTarget::hear(const SoundBlock& sound, std::int64_t tick) {
    sound_->add(sound, tick);
    send_sound();
}

void StreamTarget::finish() {
    if (sound_) {
        sound_->encoder().end();
        send_sound();
    }
    if (const int code = av_write_trailer(output_.get()); code < 0)
        fail_for_peer("it does not end", code);
}

std::uint64_t StreamTarget::bytes() const {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(0, avio_tell(output_->pb)));
}

void StreamTarget::send_sound() {
    SoundEncoder& encoder = sound_->encoder();
    while (AVPacket* packet = encoder.next()) {
        // MPEG-TS has no times before the first frame; a decoder can start with the next packet.
        if (packet->pts >= 0) mux(*packet, encoder.context().time_base, *sound_stream_);
    }
}

void StreamTarget::mux(AVPacket& packet, AVRational time_base, const AVStream& stream) {
    av_packet_rescale_ts(&packet, time_base, stream.time_base);
    packet.stream_index = stream.index;
    if (const int code = av_write_frame(output_.get(), &packet); code < 0)
        fail_for_peer("its peer or the network is gone", code);
}

std::shared_ptr<SharedEncoder> stream_encoder(const OutputUrl& url, const OutputFormat& format) {
    if (format.width_px % 2 != 0 || format.height_px % 2 != 0)
        fail("the output {}: a stream of {}x{} cannot be sent: its sides have to be even",
             url.shown, format.width_px, format.height_px);
    // Yields 4.6 Mbit/s at 1280x720 and 50 Hz and 10.4 Mbit/s at 1920x1080, which contribution
    // links carry.
    constexpr double bits_a_pixel = 0.1, least_bps = 500e3;
    const double usual_bps =
        std::max(least_bps, bits_a_pixel * format.width_px * format.height_px * format.rate_hz);
    const EncoderSettings settings{
        .width_px = format.width_px,
        .height_px = format.height_px,
        .rate_hz = format.rate_hz,
        .bit_rate_bps = url.bit_rate_bps().value_or(std::llround(usual_bps)),
        .is_live = true};
    return format.encoders ? format.encoders->find(format.encoder, settings)
                           : std::make_shared<SharedEncoder>(format.encoder, settings);
}

}  // namespace vantage
