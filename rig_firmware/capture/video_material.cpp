#include <memory>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libswscale/swscale.h>
}

#include "common/base/error.h"
#include "common/image/image_file.h"
#include "rig_firmware/capture/stereo_material.h"

namespace vantage {
namespace {

struct FreeFormat {
    void operator()(AVFormatContext* format) const { avformat_close_input(&format); }
};
struct FreeCodec {
    void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
};
struct FreeFrame {
    void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
struct FreePacket {
    void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
struct FreeScaler {
    void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

std::string reason(int code) {
    char text[AV_ERROR_MAX_STRING_SIZE] = {};
    av_strerror(code, text, sizeof text);
    return text;
}

/// Decodes the pictures of a video file one after the other.
class VideoReader {
  public:
    explicit VideoReader(const std::string& path)
        : path_(path), frame_(av_frame_alloc()), packet_(av_packet_alloc()) {
        AVFormatContext* format = nullptr;
        if (const int code = avformat_open_input(&format, path.c_str(), nullptr, nullptr); code < 0)
            fail("{} is neither a picture nor a video that can be read: {}", path, reason(code));
        format_.reset(format);
        if (const int code = avformat_find_stream_info(format, nullptr); code < 0)
            fail("{} cannot be read as a video: {}", path, reason(code));
        const AVCodec* decoder = nullptr;
        stream_ = av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0);
        if (stream_ < 0 || !decoder) fail("{} holds no video that can be decoded", path);
        codec_.reset(avcodec_alloc_context3(decoder));
        avcodec_parameters_to_context(codec_.get(), format->streams[stream_]->codecpar);
        if (const int code = avcodec_open2(codec_.get(), decoder, nullptr); code < 0)
            fail("the video of {} cannot be decoded: {}", path, reason(code));
    }

    /// Empty at the end.
    std::optional<ColourImage> next() {
        for (;;) {
            const int code = avcodec_receive_frame(codec_.get(), frame_.get());
            if (code == 0) return to_colour();
            if (code == AVERROR_EOF) return std::nullopt;
            if (code != AVERROR(EAGAIN)) fail("{} is damaged: {}", path_, reason(code));
            feed();
        }
    }

    const char* codec_name() const { return codec_->codec->name; }

  private:
    /// Hands the decoder the next packet of the video, or tells it that there is none.
    void feed() {
        for (;;) {
            const int code = av_read_frame(format_.get(), packet_.get());
            if (code == AVERROR_EOF) {
                avcodec_send_packet(codec_.get(), nullptr);
                return;
            }
            if (code < 0) fail("{} is damaged: {}", path_, reason(code));
            const bool is_video = packet_->stream_index == stream_;
            const int sent = is_video ? avcodec_send_packet(codec_.get(), packet_.get()) : 0;
            av_packet_unref(packet_.get());
            if (sent < 0) fail("{} is damaged: {}", path_, reason(sent));
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
    std::unique_ptr<AVFormatContext, FreeFormat> format_;
    std::unique_ptr<AVCodecContext, FreeCodec> codec_;
    std::unique_ptr<SwsContext, FreeScaler> scaler_;
    std::unique_ptr<AVFrame, FreeFrame> frame_;
    std::unique_ptr<AVPacket, FreePacket> packet_;
    int stream_ = -1;
};

class SideBySideVideo final : public StereoMaterial {
  public:
    explicit SideBySideVideo(const RigConfig::Source& source)
        : path_(source.left), loop_(source.loop), reader_(open()) {
        waiting_ = reader_->next();
        if (!waiting_) fail("{} holds no picture", path_);
        size_ = split_side_by_side(*waiting_, path_).left.size();
    }

    cv::Size size() const override { return size_; }

    std::optional<StereoPair> pair_of(std::uint64_t) override {
        std::optional<ColourImage> picture = std::exchange(waiting_, std::nullopt);
        if (!picture) picture = reader_->next();
        if (!picture && loop_) {
            reader_ = open();
            picture = reader_->next();
        }
        if (!picture) return std::nullopt;
        const StereoPair pair = split_side_by_side(*picture, path_);
        if (pair.left.size() != size_)
            fail("{} changes its size from {}x{} to {}x{}: all its pictures must have one", path_,
                 size_.width, size_.height, pair.left.cols, pair.left.rows);
        return pair;
    }

    std::string describe() const override {
        return fmt::format("video {} ({}), side by side{}", path_, reader_->codec_name(),
                           loop_ ? ", looping" : "");
    }

  private:
    std::unique_ptr<VideoReader> open() const { return std::make_unique<VideoReader>(path_); }

    std::string path_;
    bool loop_;
    std::unique_ptr<VideoReader> reader_;
    std::optional<ColourImage> waiting_;  ///< the first picture, read at construction for its size
    cv::Size size_;
};

}  // namespace

std::unique_ptr<StereoMaterial> open_video(const RigConfig::Source& source) {
    // What goes wrong is said by our own sentence.
    av_log_set_level(AV_LOG_QUIET);
    return std::make_unique<SideBySideVideo>(source);
}

}  // namespace vantage
