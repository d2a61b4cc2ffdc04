#include "rig_firmware/capture/material/video_reader.h"

#include "common/av/av_handles.h"
#include "common/av/av_log.h"
#include "common/base/error.h"
#include "common/image/image_file.h"

namespace vantage {
namespace {

struct CloseInput {
    void operator()(AVFormatContext* format) const { avformat_close_input(&format); }
};

}  // namespace

struct VideoReader::Impl {
    explicit Impl(const std::string& path)
        : path_(path), frame_(av_frame_alloc()), packet_(av_packet_alloc()) {
        AVFormatContext* format = nullptr;
        if (const int code = avformat_open_input(&format, path.c_str(), nullptr, nullptr); code < 0)
            fail("{} is neither a picture nor a video that can be read: {}", path, av_reason(code));
        format_.reset(format);
        if (const int code = avformat_find_stream_info(format, nullptr); code < 0)
            fail("{} cannot be read as a video: {}", path, av_reason(code));
        const AVCodec* decoder = nullptr;
        stream_ = av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0);
        if (stream_ < 0 || !decoder) fail("{} holds no video that can be decoded", path);
        codec_.reset(avcodec_alloc_context3(decoder));
        avcodec_parameters_to_context(codec_.get(), format->streams[stream_]->codecpar);
        codec_->thread_count = 0;  // one thread for each processor
        if (const int code = avcodec_open2(codec_.get(), decoder, nullptr); code < 0)
            fail("the video of {} cannot be decoded: {}", path, av_reason(code));
    }

    std::optional<ColourImage> next() {
        for (;;) {
            const int code = avcodec_receive_frame(codec_.get(), frame_.get());
            if (code == 0) return to_colour();
            if (code == AVERROR_EOF) return std::nullopt;
            if (code != AVERROR(EAGAIN)) fail("{} is damaged: {}", path_, av_reason(code));
            feed();
        }
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
    std::unique_ptr<AVFormatContext, CloseInput> format_;
    AvCodecContextPtr codec_;
    SwsContextPtr scaler_;
    AvFramePtr frame_;
    AvPacketPtr packet_;
    int stream_ = -1;
};

VideoReader::VideoReader(const std::string& path) {
    // Our own sentence reports errors, so FFmpeg's log is kept for it.
    keep_av_log();
    impl_ = std::make_unique<Impl>(path);
}

VideoReader::~VideoReader() = default;

std::optional<ColourImage> VideoReader::next() { return impl_->next(); }

const char* VideoReader::codec_name() const { return impl_->codec_->codec->name; }

double VideoReader::rate_hz() const {
    AVFormatContext* format = impl_->format_.get();
    const AVRational rate = av_guess_frame_rate(format, format->streams[impl_->stream_], nullptr);
    return rate.num > 0 && rate.den > 0 ? av_q2d(rate) : 0;
}

}  // namespace vantage
