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

/// FFV1's minimum; more slices cost bytes.
constexpr int slices = 4;

/// FFV1 has B, G, R, A and our images R, G, B, A. The codec does not care, but a player would swap
/// red and blue, so the channels are swapped.
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
    if (!codec) fail("this FFmpeg has no FFV1 encoder, which takes need");
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
    check(avcodec_open2(codec_.get(), codec, nullptr), "start");
    frame_.reset(av_frame_alloc());
    packet_.reset(av_packet_alloc());
    frame_->format = codec_->pix_fmt;
    frame_->width = size_px.width;
    frame_->height = size_px.height;
    check(av_frame_get_buffer(frame_.get(), 0), "allocate memory");
}

std::vector<std::byte> LosslessPictureEncoder::setup() const {
    const auto* bytes = reinterpret_cast<const std::byte*>(codec_->extradata);
    return {bytes, bytes + codec_->extradata_size};
}

std::vector<std::byte> LosslessPictureEncoder::encode(const cv::Mat& picture) {
    check(av_frame_make_writable(frame_.get()), "allocate memory");
    const auto row_bytes = static_cast<std::size_t>(picture.cols) * picture.elemSize();
    for (int y = 0; y < picture.rows; ++y) {
        std::uint8_t* row = frame_->data[0] + static_cast<std::ptrdiff_t>(y) * frame_->linesize[0];
        std::memcpy(row, picture.ptr(y), row_bytes);
        if (frame_->format == AV_PIX_FMT_BGRA) swap_red_and_blue(row, picture.cols);
    }
    frame_->pts = number_++;
    check(avcodec_send_frame(codec_.get(), frame_.get()), "take a frame");
    check(avcodec_receive_packet(codec_.get(), packet_.get()), "encode a frame");
    const auto* bytes = reinterpret_cast<const std::byte*>(packet_->data);
    std::vector<std::byte> coded(bytes, bytes + packet_->size);
    av_packet_unref(packet_.get());
    return coded;
}

LosslessPictureDecoder::LosslessPictureDecoder(cv::Size size_px, int type,
                                               std::span<const std::byte> setup)
    : size_px_(size_px), type_(type) {
    const AVCodec* codec = avcodec_find_decoder(AV_CODEC_ID_FFV1);
    if (!codec) fail("this FFmpeg has no FFV1 decoder, which takes need");
    codec_.reset(avcodec_alloc_context3(codec));
    codec_->width = size_px.width;
    codec_->height = size_px.height;
    codec_->thread_count = threads();
    codec_->thread_type = FF_THREAD_SLICE;
    // A damaged slice is an error, not a frame with a hole.
    codec_->err_recognition = AV_EF_CRCCHECK | AV_EF_EXPLODE;
    codec_->extradata =
        static_cast<std::uint8_t*>(av_mallocz(setup.size() + AV_INPUT_BUFFER_PADDING_SIZE));
    std::memcpy(codec_->extradata, setup.data(), setup.size());
    codec_->extradata_size = static_cast<int>(setup.size());
    check(avcodec_open2(codec_.get(), codec, nullptr), "start");
    frame_.reset(av_frame_alloc());
    packet_.reset(av_packet_alloc());
}

cv::Mat LosslessPictureDecoder::decode(std::span<const std::byte> bytes, cv::Mat memory) {
    check(av_new_packet(packet_.get(), static_cast<int>(bytes.size())), "allocate memory");
    std::memcpy(packet_->data, bytes.data(), bytes.size());
    const int sent = avcodec_send_packet(codec_.get(), packet_.get());
    av_packet_unref(packet_.get());
    const int received = sent < 0 ? sent : avcodec_receive_frame(codec_.get(), frame_.get());
    // For some damage the decoder only marks its frame as corrupt.
    if (received < 0 || (frame_->flags & AV_FRAME_FLAG_CORRUPT) != 0 ||
        frame_->decode_error_flags != 0 || frame_->format != pixel_format(type_) ||
        frame_->width != size_px_.width || frame_->height != size_px_.height) {
        av_frame_unref(frame_.get());
        fail("a lossless image of {} bytes is damaged", bytes.size());
    }
    cv::Mat picture = memory.empty() ? cv::Mat(size_px_, type_) : std::move(memory);
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
