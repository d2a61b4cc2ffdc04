#include "common/take/format/lossless_pictures.h"

#include <algorithm>
#include <cstring>
#include <thread>

extern "C" {
#include <libavutil/opt.h>
}

#include "common/base/error.h"

namespace vantage {
namespace {

/// FFV1 takes 4 and more; more of them cost bytes.
constexpr int slices = 4;

/// FFV1 knows B, G, R, A and our pictures are R, G, B, A: the names of the channels are of no
/// interest to it, and a player would show red as blue. So they are swapped.
AVPixelFormat pixel_format(int type) {
    return type == CV_16UC1 ? AV_PIX_FMT_GRAY16LE : AV_PIX_FMT_BGRA;
}

int threads() {
    return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, slices);
}

void swap_red_and_blue(std::uint8_t* row, int pixels) {
    for (int x = 0; x < pixels; ++x) std::swap(row[4 * x], row[4 * x + 2]);
}

void check(int code, const char* what) {
    if (code < 0) fail("FFV1 cannot {}: {}", what, av_reason(code));
}

}  // namespace

LosslessPictureEncoder::LosslessPictureEncoder(cv::Size size_px, int type) {
    const AVCodec* codec = avcodec_find_encoder(AV_CODEC_ID_FFV1);
    if (!codec) fail("this FFmpeg comes without FFV1, which takes are written with");
    codec_.reset(avcodec_alloc_context3(codec));
    codec_->width = size_px.width;
    codec_->height = size_px.height;
    codec_->pix_fmt = pixel_format(type);
    codec_->time_base = {1, 1000};
    codec_->gop_size = 1;
    codec_->level = 3;
    codec_->slices = slices;
    codec_->thread_count = threads();
    codec_->thread_type = FF_THREAD_SLICE;
    av_opt_set_int(codec_->priv_data, "slicecrc", 1, 0);
    av_opt_set(codec_->priv_data, "coder", "range_tab", 0);
    check(avcodec_open2(codec_.get(), codec, nullptr), "be started");
    frame_.reset(av_frame_alloc());
    packet_.reset(av_packet_alloc());
    frame_->format = codec_->pix_fmt;
    frame_->width = size_px.width;
    frame_->height = size_px.height;
    check(av_frame_get_buffer(frame_.get(), 0), "take memory");
}

std::vector<std::byte> LosslessPictureEncoder::setup() const {
    const auto* bytes = reinterpret_cast<const std::byte*>(codec_->extradata);
    return {bytes, bytes + codec_->extradata_size};
}

std::vector<std::byte> LosslessPictureEncoder::encode(const cv::Mat& picture) {
    check(av_frame_make_writable(frame_.get()), "take memory");
    const auto row_bytes = static_cast<std::size_t>(picture.cols) * picture.elemSize();
    for (int y = 0; y < picture.rows; ++y) {
        std::uint8_t* row = frame_->data[0] + static_cast<std::ptrdiff_t>(y) * frame_->linesize[0];
        std::memcpy(row, picture.ptr(y), row_bytes);
        if (frame_->format == AV_PIX_FMT_BGRA) swap_red_and_blue(row, picture.cols);
    }
    frame_->pts = number_++;
    check(avcodec_send_frame(codec_.get(), frame_.get()), "take a picture");
    check(avcodec_receive_packet(codec_.get(), packet_.get()), "code a picture");
    const auto* bytes = reinterpret_cast<const std::byte*>(packet_->data);
    std::vector<std::byte> coded(bytes, bytes + packet_->size);
    av_packet_unref(packet_.get());
    return coded;
}

LosslessPictureDecoder::LosslessPictureDecoder(cv::Size size_px, int type,
                                               std::span<const std::byte> setup)
    : size_px_(size_px), type_(type) {
    const AVCodec* codec = avcodec_find_decoder(AV_CODEC_ID_FFV1);
    if (!codec) fail("this FFmpeg comes without FFV1, which takes are read with");
    codec_.reset(avcodec_alloc_context3(codec));
    codec_->width = size_px.width;
    codec_->height = size_px.height;
    codec_->thread_count = threads();
    codec_->thread_type = FF_THREAD_SLICE;
    // A slice that is damaged is an error and no picture with a hole.
    codec_->err_recognition = AV_EF_CRCCHECK | AV_EF_EXPLODE;
    codec_->extradata =
        static_cast<std::uint8_t*>(av_mallocz(setup.size() + AV_INPUT_BUFFER_PADDING_SIZE));
    std::memcpy(codec_->extradata, setup.data(), setup.size());
    codec_->extradata_size = static_cast<int>(setup.size());
    check(avcodec_open2(codec_.get(), codec, nullptr), "be started");
    frame_.reset(av_frame_alloc());
    packet_.reset(av_packet_alloc());
}

cv::Mat LosslessPictureDecoder::decode(std::span<const std::byte> bytes) {
    check(av_new_packet(packet_.get(), static_cast<int>(bytes.size())), "take memory");
    std::memcpy(packet_->data, bytes.data(), bytes.size());
    const int sent = avcodec_send_packet(codec_.get(), packet_.get());
    av_packet_unref(packet_.get());
    const int received = sent < 0 ? sent : avcodec_receive_frame(codec_.get(), frame_.get());
    // The decoder says of some damage only that its picture is not right.
    if (received < 0 || (frame_->flags & AV_FRAME_FLAG_CORRUPT) != 0 ||
        frame_->decode_error_flags != 0 || frame_->format != pixel_format(type_) ||
        frame_->width != size_px_.width || frame_->height != size_px_.height) {
        av_frame_unref(frame_.get());
        fail("a lossless picture of {} bytes is damaged", bytes.size());
    }
    cv::Mat picture(size_px_, type_);
    const auto row_bytes = static_cast<std::size_t>(picture.cols) * picture.elemSize();
    for (int y = 0; y < picture.rows; ++y) {
        std::memcpy(picture.ptr(y),
                    frame_->data[0] + static_cast<std::ptrdiff_t>(y) * frame_->linesize[0],
                    row_bytes);
        if (type_ == CV_8UC4) swap_red_and_blue(picture.ptr(y), picture.cols);
    }
    av_frame_unref(frame_.get());
    return picture;
}

}  // namespace vantage
