#include "host_app/output/video_writer.h"

#include <cassert>
#include <cmath>

#include <unistd.h>

#include "common/base/error.h"
#include "common/base/pulse_grid.h"
#include "host_app/output/mp4_fragments.h"

extern "C" {
#include <libavutil/opt.h>
}

namespace vantage {
namespace {

/// The finest common clock of broadcast rates, 30000/1001 Hz included.
constexpr AVRational time_base = {1, 90000};

const AVCodec* find_encoder() {
    if (const AVCodec* x264 = avcodec_find_encoder_by_name("libx264")) return x264;
    return avcodec_find_encoder(AV_CODEC_ID_MPEG4);
}

const char* container_of(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    if (extension == ".mkv") return "matroska";
    if (extension == ".mp4") return "mp4";
    fail("{} cannot be written: a film is a .mkv or .mp4 file, not '{}'", path.string(), extension);
}

/// Whether a file opens and has a picture.
bool is_readable(const std::filesystem::path& path) {
    AVFormatContext* input = nullptr;
    if (avformat_open_input(&input, path.c_str(), nullptr, nullptr) < 0) return false;
    const AvPacketPtr packet(av_packet_alloc());
    const bool has_picture = av_read_frame(input, packet.get()) >= 0;
    avformat_close_input(&input);
    return has_picture;
}

}  // namespace

VideoWriter::VideoWriter(std::filesystem::path path, const VideoSettings& settings)
    : path_(std::move(path)), partial_(path_.string() + fmt::format(".partial-{}", getpid())) {
    if (settings.width_px < 2 || settings.height_px < 2)
        fail("{} cannot be written: a film of {}x{} pixels is too small", path_.string(),
             settings.width_px, settings.height_px);
    // The encoder tells of every start and end otherwise.
    av_log_set_level(AV_LOG_ERROR);
    AVFormatContext* output = nullptr;
    if (const int code =
            avformat_alloc_output_context2(&output, nullptr, container_of(path_), partial_.c_str());
        code < 0)
        fail_writing(code);
    output_.reset(output);
    open_encoder(settings);
    open_file();
}

VideoWriter::~VideoWriter() {
    if (finished_) return;
    output_.reset();
    std::error_code ignored;
    std::filesystem::remove(partial_, ignored);
}

void VideoWriter::open_encoder(const VideoSettings& settings) {
    const AVCodec* codec = find_encoder();
    if (!codec) fail("{} cannot be written: FFmpeg has no video encoder here", path_.string());
    encoder_.reset(avcodec_alloc_context3(codec));
    encoder_->width = settings.width_px & ~1;
    encoder_->height = settings.height_px & ~1;
    encoder_->pix_fmt = AV_PIX_FMT_YUV420P;
    encoder_->time_base = time_base;
    // 29.97 is 30000/1001, as drop-frame time code wants it.
    encoder_->framerate = av_d2q(PulseGrid(settings.rate_hz).rate_hz(), 120'000);
    encoder_->gop_size = std::max(1, static_cast<int>(std::lround(2 * settings.rate_hz)));
    encoder_->colorspace = AVCOL_SPC_BT709;
    encoder_->color_primaries = AVCOL_PRI_BT709;
    encoder_->color_trc = AVCOL_TRC_BT709;
    encoder_->color_range = AVCOL_RANGE_MPEG;
    if (output_->oformat->flags & AVFMT_GLOBALHEADER)
        encoder_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    if (codec->id == AV_CODEC_ID_H264) {
        av_opt_set(encoder_->priv_data, "preset", "veryfast", 0);
        av_opt_set_double(encoder_->priv_data, "crf", settings.quality, 0);
    } else {
        // MPEG-4 takes clocks of 16 bits only.
        encoder_->time_base = {1, 60000};
        encoder_->flags |= AV_CODEC_FLAG_QSCALE;
        encoder_->global_quality = 3 * FF_QP2LAMBDA;
    }
    if (const int code = avcodec_open2(encoder_.get(), codec, nullptr); code < 0)
        fail("{} cannot be written: the encoder {} does not take {}x{} at {} Hz ({})",
             path_.string(), codec->name, encoder_->width, encoder_->height, settings.rate_hz,
             av_reason(code));

    to_yuv_.reset(sws_getContext(encoder_->width, encoder_->height, AV_PIX_FMT_RGBA,
                                 encoder_->width, encoder_->height, AV_PIX_FMT_YUV420P,
                                 SWS_BILINEAR | SWS_ACCURATE_RND, nullptr, nullptr, nullptr));
    if (!to_yuv_) fail("{} cannot be written: memory is short", path_.string());
    constexpr int full_range = 1, studio_range = 0, unchanged = 1 << 16;
    sws_setColorspaceDetails(to_yuv_.get(), sws_getCoefficients(SWS_CS_ITU709), full_range,
                             sws_getCoefficients(SWS_CS_ITU709), studio_range, 0, unchanged,
                             unchanged);
    frame_.reset(av_frame_alloc());
    packet_.reset(av_packet_alloc());
    frame_->format = encoder_->pix_fmt;
    frame_->width = encoder_->width;
    frame_->height = encoder_->height;
    if (const int code = av_frame_get_buffer(frame_.get(), 0); code < 0) fail_writing(code);
}

void VideoWriter::open_file() {
    stream_ = avformat_new_stream(output_.get(), nullptr);
    if (!stream_) fail("{} cannot be written: memory is short", path_.string());
    stream_->time_base = encoder_->time_base;
    stream_->avg_frame_rate = encoder_->framerate;
    avcodec_parameters_from_context(stream_->codecpar, encoder_.get());
    if (const int code = avio_open(&output_->pb, partial_.c_str(), AVIO_FLAG_WRITE); code < 0)
        fail_writing(code);
    // What a failure may cost: a cluster of Matroska, a fragment of MP4.
    av_opt_set_int(output_->priv_data, "cluster_time_limit", 1000, 0);
    av_opt_set_int(output_->priv_data, "frag_duration", 1'000'000, 0);
    // The head waits for the first fragment, which says when the film begins.
    av_opt_set(output_->priv_data, "movflags", "delay_moov+default_base_moof", 0);
}

void VideoWriter::begin(const std::string& timecode) {
    if (!timecode.empty()) av_dict_set(&stream_->metadata, "timecode", timecode.c_str(), 0);
    if (const int code = avformat_write_header(output_.get(), nullptr); code < 0)
        fail_writing(code);
    has_begun_ = true;
}

void VideoWriter::add(const ColourImage& picture, std::chrono::nanoseconds time,
                      const std::string& timecode) {
    assert(!finished_);
    if (!has_begun_) begin(timecode);
    assert(picture.cols >= frame_->width && picture.rows >= frame_->height);
    if (const int code = av_frame_make_writable(frame_.get()); code < 0) fail_writing(code);
    const std::uint8_t* rows[] = {picture.data};
    const int strides[] = {static_cast<int>(picture.step)};
    sws_scale(to_yuv_.get(), rows, strides, 0, frame_->height, frame_->data, frame_->linesize);
    frame_->pts = av_rescale_q(time.count(), {1, 1'000'000'000}, encoder_->time_base);
    assert(frame_->pts > last_pts_);
    last_pts_ = frame_->pts;
    if (const int code = avcodec_send_frame(encoder_.get(), frame_.get()); code < 0)
        fail_writing(code);
    drain();
    ++frames_;
}

void VideoWriter::finish() {
    if (frames_ == 0) fail("{} is not written: the film has no picture", path_.string());
    if (const int code = avcodec_send_frame(encoder_.get(), nullptr); code < 0) fail_writing(code);
    drain();
    is_ended_ = true;
    if (const int code = av_write_trailer(output_.get()); code < 0) fail_writing(code);
    if (const int code = avio_closep(&output_->pb); code < 0) fail_writing(code);
    std::error_code error;
    std::filesystem::rename(partial_, path_, error);
    if (error) fail("cannot write {}: {}", path_.string(), error.message());
    finished_ = true;
}

std::string VideoWriter::codec_name() const { return encoder_->codec->name; }

void VideoWriter::drain() {
    for (;;) {
        const int received = avcodec_receive_packet(encoder_.get(), packet_.get());
        if (received == AVERROR(EAGAIN) || received == AVERROR_EOF) return;
        if (received < 0) fail_writing(received);
        av_packet_rescale_ts(packet_.get(), encoder_->time_base, stream_->time_base);
        packet_->stream_index = stream_->index;
        if (const int code = av_interleaved_write_frame(output_.get(), packet_.get()); code < 0)
            fail_writing(code);
    }
}

bool VideoWriter::keep_what_is_written() noexcept {
    if (finished_) return true;
    // Without the index that an end would write, the file still opens.
    if (has_begun_ && !is_ended_) av_write_trailer(output_.get());
    is_ended_ = true;
    avio_closep(&output_->pb);
    try {
        if (path_.extension() == ".mp4") cut_to_whole_fragments(partial_);
    } catch (const Error&) {
        return false;
    }
    if (!is_readable(partial_)) return false;
    std::error_code error;
    std::filesystem::rename(partial_, path_, error);
    finished_ = !error;
    return finished_;
}

void VideoWriter::fail_writing(int code) const {
    fail("cannot write {}: {}", path_.string(), av_reason(code));
}

}  // namespace vantage
