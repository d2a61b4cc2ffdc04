#include "common/av/video_reader.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/av/av_input.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/image/exif_orientation.h"
#include "common/image/image_file.h"

namespace vantage {
namespace {

/// The display matrix of a video, as a phone writes it; null if there is none.
const std::int32_t* display_matrix_of(const AVStream& stream) {
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(60, 31, 102)
    const AVPacketSideData* data =
        av_packet_side_data_get(stream.codecpar->coded_side_data,
                                stream.codecpar->nb_coded_side_data, AV_PKT_DATA_DISPLAYMATRIX);
    return data ? reinterpret_cast<const std::int32_t*>(data->data) : nullptr;
#else
    return reinterpret_cast<const std::int32_t*>(
        av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr));
#endif
}

/// How players show the video, as a code of EXIF; 1 where they show it as it is stored.
int stated_orientation(const AVStream& stream) {
    const std::int32_t* matrix = display_matrix_of(stream);
    if (!matrix) return 1;
    // The shown x is a * x + c * y, and the shown y is b * x + d * y.
    const std::int32_t a = matrix[0], b = matrix[1], c = matrix[3], d = matrix[4];
    if (std::abs(static_cast<double>(a)) >= std::abs(static_cast<double>(b)))
        return a >= 0 ? (d >= 0 ? 1 : 4) : (d >= 0 ? 2 : 3);
    return b >= 0 ? (c >= 0 ? 5 : 6) : (c >= 0 ? 8 : 7);
}

}  // namespace

struct VideoReader::Impl {
    explicit Impl(const std::string& path)
        : path_(path), frame_(av_frame_alloc()), packet_(av_packet_alloc()) {
        int code = 0;
        format_ = open_av_input(path, code);
        if (!format_)
            fail("{} is neither a picture nor a video that can be read: {}", path, av_reason(code));
        const AVCodec* decoder = nullptr;
        stream_ = find_av_stream(*format_, AVMEDIA_TYPE_VIDEO, &decoder);
        if (stream_ < 0 || !decoder) fail("{} holds no video that can be decoded", path);
        constexpr int thread_for_each_processor = 0;
        const AVStream& stream = *format_->streams[stream_];
        code = open_av_decoder(stream, *decoder, thread_for_each_processor, codec_);
        if (code < 0) fail("the video of {} cannot be decoded: {}", path, av_reason(code));
        if (const int orientation = stated_orientation(stream); orientation != 1)
            log_warning_once(
                fmt::format("video orientation {}", orientation),
                fmt::format("{} states that players show it {}; Vantage takes the frames as they "
                            "are stored, here and in other videos like it. Turn the video itself "
                            "if it should stand upright (ffmpeg -i FILE OUT turns the frames)",
                            path, orientation_in_words(orientation)));
    }

    /// Decodes the next frame to frame_. Returns false at the end.
    bool decode() {
        if (std::exchange(has_pending_, false)) return true;
        for (;;) {
            const int code = avcodec_receive_frame(codec_.get(), frame_.get());
            if (code == 0) return true;
            if (code == AVERROR_EOF) return false;
            if (code != AVERROR(EAGAIN)) fail("{} is damaged: {}", path_, av_reason(code));
            feed();
        }
    }

    bool has_constant_rate() const {
        const AVStream* stream = format_->streams[stream_];
        const AVRational rate = stream->avg_frame_rate;
        return rate.num > 0 && rate.den > 0 && av_cmp_q(rate, stream->r_frame_rate) == 0;
    }
    /// Time stamp of a frame; precondition: the rate is constant.
    std::int64_t time_of(std::uint64_t frame) const {
        const AVStream* stream = format_->streams[stream_];
        const std::int64_t start = stream->start_time == AV_NOPTS_VALUE ? 0 : stream->start_time;
        return start + av_rescale_q(static_cast<std::int64_t>(frame),
                                    av_inv_q(stream->avg_frame_rate), stream->time_base);
    }

    std::optional<std::uint64_t> key_frame_before(std::uint64_t frame) const {
        if (!has_constant_rate()) return std::nullopt;
        AVStream* stream = format_->streams[stream_];
        const AVIndexEntry* entry =
            avformat_index_get_entry_from_timestamp(stream, time_of(frame), AVSEEK_FLAG_BACKWARD);
        if (!entry) return std::nullopt;
        const std::int64_t number = av_rescale_q(entry->timestamp - time_of(0), stream->time_base,
                                                 av_inv_q(stream->avg_frame_rate));
        return static_cast<std::uint64_t>(std::max<std::int64_t>(0, number));
    }

    bool seek(std::uint64_t frame) {
        if (!has_constant_rate()) return false;
        const AVStream* stream = format_->streams[stream_];
        const std::int64_t period =
            av_rescale_q(1, av_inv_q(stream->avg_frame_rate), stream->time_base);
        const std::int64_t wanted = time_of(frame);
        if (av_seek_frame(format_.get(), stream_, wanted, AVSEEK_FLAG_BACKWARD) < 0) return false;
        avcodec_flush_buffers(codec_.get());
        has_pending_ = false;
        while (decode()) {
            const std::int64_t time = frame_->best_effort_timestamp;
            if (time == AV_NOPTS_VALUE || time > wanted + period / 2) return false;
            if (time >= wanted - period / 2) return has_pending_ = true;
        }
        return false;
    }

    std::uint64_t count() {
        const std::int64_t stated = format_->streams[stream_]->nb_frames;
        if (stated > 0) return static_cast<std::uint64_t>(stated);
        std::uint64_t frames = 0;
        while (av_read_frame(format_.get(), packet_.get()) >= 0) {
            if (packet_->stream_index == stream_ && !(packet_->flags & AV_PKT_FLAG_DISCARD))
                ++frames;
            av_packet_unref(packet_.get());
        }
        return frames;
    }

    /// Sends the next packet of the video to the decoder, or the end of the stream.
    void feed() {
        for (;;) {
            const int code = av_read_frame(format_.get(), packet_.get());
            if (code == AVERROR_EOF) {
                avcodec_send_packet(codec_.get(), nullptr);
                return;
            }
            if (code < 0) fail("{} is damaged: {}", path_, av_reason(code));
            const bool is_video = packet_->stream_index == stream_;
            const int sent = is_video ? avcodec_send_packet(codec_.get(), packet_.get()) : 0;
            av_packet_unref(packet_.get());
            if (sent < 0) fail("{} is damaged: {}", path_, av_reason(sent));
            if (is_video) return;
        }
    }

    ColourImage to_colour() {
        const int width = frame_->width, height = frame_->height;
        if (width < 1 || height < 1 || width > max_image_side_px || height > max_image_side_px)
            fail("{} has pictures of {}x{}, and the limit is {} px a side", path_, width, height,
                 max_image_side_px);
        SwsContext* scaler = sws_getCachedContext(
            scaler_.release(), width, height, static_cast<AVPixelFormat>(frame_->format), width,
            height, AV_PIX_FMT_RGBA, SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT, nullptr,
            nullptr, nullptr);
        if (!scaler) fail("{} has pictures in a form that cannot be converted", path_);
        scaler_.reset(scaler);
        ColourImage picture(height, width);
        std::uint8_t* rows[] = {picture.data};
        const int strides[] = {static_cast<int>(picture.step)};
        sws_scale(scaler, frame_->data, frame_->linesize, 0, height, rows, strides);
        return picture;
    }

    std::string path_;
    AvInputPtr format_;
    AvCodecContextPtr codec_;
    SwsContextPtr scaler_;
    AvFramePtr frame_;
    AvPacketPtr packet_;
    int stream_ = -1;
    bool has_pending_ = false;  ///< frame_ is the next one
};

VideoReader::VideoReader(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}

VideoReader::~VideoReader() = default;

std::optional<ColourImage> VideoReader::next() {
    if (!impl_->decode()) return std::nullopt;
    return impl_->to_colour();
}

bool VideoReader::skip(std::uint64_t frames) {
    for (; frames > 0; --frames)
        if (!impl_->decode()) return false;
    return true;
}

bool VideoReader::seek(std::uint64_t frame) { return impl_->seek(frame); }

std::optional<std::uint64_t> VideoReader::key_frame_before(std::uint64_t frame) const {
    return impl_->key_frame_before(frame);
}

std::uint64_t VideoReader::count() { return impl_->count(); }

const char* VideoReader::codec_name() const { return impl_->codec_->codec->name; }

double VideoReader::rate_hz() const {
    AVFormatContext* format = impl_->format_.get();
    const AVRational rate = av_guess_frame_rate(format, format->streams[impl_->stream_], nullptr);
    return rate.num > 0 && rate.den > 0 ? av_q2d(rate) : 0;
}

}  // namespace vantage
