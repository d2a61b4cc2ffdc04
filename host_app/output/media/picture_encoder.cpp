#include "host_app/output/media/picture_encoder.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/ranges.h>

#include "common/av/av_log.h"
#include "common/base/cli/nearest_name.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time/pulse_grid.h"

extern "C" {
#include <libavutil/hwcontext.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

namespace vantage {

PictureConverter::PictureConverter(int width_px, int height_px, AVPixelFormat format)
    : context_(sws_getContext(width_px, height_px, AV_PIX_FMT_RGBA, width_px, height_px, format,
                              SWS_BILINEAR | SWS_ACCURATE_RND, nullptr, nullptr, nullptr)),
      frame_(av_frame_alloc()) {
    if (!context_ || !frame_)
        fail("pictures of {}x{} cannot be made {}", width_px, height_px,
             av_get_pix_fmt_name(format));
    constexpr int full_range = 1, studio_range = 0, unchanged = 1 << 16;
    sws_setColorspaceDetails(context_.get(), sws_getCoefficients(SWS_CS_ITU709), full_range,
                             sws_getCoefficients(SWS_CS_ITU709), studio_range, 0, unchanged,
                             unchanged);
    frame_->format = format;
    frame_->width = width_px;
    frame_->height = height_px;
    frame_->colorspace = AVCOL_SPC_BT709;
    frame_->color_primaries = AVCOL_PRI_BT709;
    frame_->color_trc = AVCOL_TRC_BT709;
    frame_->color_range = AVCOL_RANGE_MPEG;
    if (av_frame_get_buffer(frame_.get(), 0) < 0) fail("memory is short");
}

AVFrame& PictureConverter::convert(const ColourImage& picture) {
    assert(picture.cols >= frame_->width && picture.rows >= frame_->height);
    // An encoder may still hold a reference to the last frame.
    if (av_frame_make_writable(frame_.get()) < 0) fail("memory is short");
    const std::uint8_t* rows[] = {picture.data};
    const int strides[] = {static_cast<int>(picture.step)};
    sws_scale(context_.get(), rows, strides, 0, frame_->height, frame_->data, frame_->linesize);
    return *frame_;
}

namespace {

constexpr const char* vaapi = "h264_vaapi";
constexpr const char* nvenc = "h264_nvenc";
constexpr const char* x264 = "libx264";

/// FFmpeg's last log message if there is one, else the text of its error code.
std::string reason(int code) {
    const std::string remark = take_av_remark();
    return remark.empty() ? av_reason(code) : remark;
}

/// Bit rate for encoders that have no quality setting, scaled from a good rate at 1280x720.
std::int64_t usual_bit_rate_bps(const EncoderSettings& settings) {
    constexpr double bits_a_pixel = 0.15;
    return std::llround(bits_a_pixel * settings.width_px * settings.height_px * settings.rate_hz);
}

}  // namespace

std::vector<std::string> known_encoders() { return {nvenc, vaapi, "h264_v4l2m2m", x264, "mpeg4"}; }

void require_known_encoder(const std::string& name) {
    const std::vector<std::string> names = known_encoders();
    if (std::find(names.begin(), names.end(), name) == names.end())
        fail("there is no encoder '{}'; {}", name, suggest_name(name, names));
}

PictureEncoder::PictureEncoder(const std::string& name, const EncoderSettings& settings)
    : packet_(av_packet_alloc()) {
    keep_av_log();
    (void)take_av_remark();
    const AVCodec* codec = avcodec_find_encoder_by_name(name.c_str());
    if (!codec) fail("FFmpeg has no encoder {} here", name);
    context_.reset(avcodec_alloc_context3(codec));
    context_->width = settings.width_px & ~1;
    context_->height = settings.height_px & ~1;
    context_->pix_fmt = AV_PIX_FMT_YUV420P;
    const PulseGrid::Fraction rate = PulseGrid(settings.rate_hz).rate();
    // MPEG-4 limits the time base to 16 bits.
    constexpr std::int64_t most_mpeg4 = 65535;
    av_reduce(&context_->framerate.num, &context_->framerate.den, rate.pulses, rate.seconds,
              codec->id == AV_CODEC_ID_MPEG4 ? most_mpeg4 : INT32_MAX);
    context_->time_base = av_inv_q(context_->framerate);
    const double key_s = settings.is_live ? 1 : 2;
    context_->gop_size = std::max(1, static_cast<int>(std::lround(key_s * settings.rate_hz)));
    context_->colorspace = AVCOL_SPC_BT709;
    context_->color_primaries = AVCOL_PRI_BT709;
    context_->color_trc = AVCOL_TRC_BT709;
    context_->color_range = AVCOL_RANGE_MPEG;
    if (settings.is_live) context_->max_b_frames = 0;
    if (settings.has_head) context_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    set_quality(settings);
    if (name == vaapi) use_vaapi();
    if (const int code = avcodec_open2(context_.get(), codec, nullptr); code < 0)
        fail("the encoder {} does not take {}x{} at {:g} Hz ({})", name, context_->width,
             context_->height, settings.rate_hz, reason(code));
    converter_.emplace(context_->width, context_->height,
                       context_->pix_fmt == AV_PIX_FMT_VAAPI ? AV_PIX_FMT_NV12 : context_->pix_fmt);
}

void PictureEncoder::set_quality(const EncoderSettings& settings) {
    const std::string name = context_->codec->name;
    void* own = context_->priv_data;
    const bool has_quality = name == x264 || name == nvenc || name == vaapi || name == "mpeg4";
    if (settings.bit_rate_bps || !has_quality) {
        context_->bit_rate = settings.bit_rate_bps.value_or(usual_bit_rate_bps(settings));
        context_->rc_max_rate = context_->bit_rate;
        // Buffer of one second; for a live stream half a second, which is the longest wait of a
        // receiver.
        context_->rc_buffer_size =
            static_cast<int>(settings.is_live ? context_->bit_rate / 2 : context_->bit_rate);
    }
    if (name == x264) {
        av_opt_set(own, "preset", "veryfast", 0);
        if (settings.is_live) av_opt_set(own, "tune", "zerolatency", 0);
        av_opt_set_int(own, "forced-idr", 1, 0);
        if (!settings.bit_rate_bps) av_opt_set_double(own, "crf", settings.quality, 0);
    } else if (name == nvenc) {
        av_opt_set(own, "preset", "p4", 0);
        if (settings.is_live) av_opt_set(own, "tune", "ull", 0);
        av_opt_set_int(own, "forced-idr", 1, 0);
        av_opt_set(own, "rc", settings.bit_rate_bps ? "cbr" : "vbr", 0);
        if (!settings.bit_rate_bps) av_opt_set_double(own, "cq", settings.quality, 0);
    } else if (name == vaapi) {
        av_opt_set(own, "rc_mode", settings.bit_rate_bps ? "CBR" : "CQP", 0);
        if (!settings.bit_rate_bps)
            context_->global_quality = static_cast<int>(std::lround(settings.quality));
    } else if (name == "mpeg4" && !settings.bit_rate_bps) {
        constexpr int fine = 3;
        context_->flags |= AV_CODEC_FLAG_QSCALE;
        context_->global_quality = fine * FF_QP2LAMBDA;
    }
}

void PictureEncoder::use_vaapi() {
    AVBufferRef* device = nullptr;
    if (const int code =
            av_hwdevice_ctx_create(&device, AV_HWDEVICE_TYPE_VAAPI, nullptr, nullptr, 0);
        code < 0)
        fail("no GPU encodes by VA-API here ({})", reason(code));
    device_.reset(device);
    const AvBufferPtr frames(av_hwframe_ctx_alloc(device));
    if (!frames) fail("memory is short");
    auto& facts = *reinterpret_cast<AVHWFramesContext*>(frames->data);
    facts.format = AV_PIX_FMT_VAAPI;
    facts.sw_format = AV_PIX_FMT_NV12;
    facts.width = context_->width;
    facts.height = context_->height;
    constexpr int pictures_at_work = 20;
    facts.initial_pool_size = pictures_at_work;
    if (const int code = av_hwframe_ctx_init(frames.get()); code < 0)
        fail("the GPU gives no pictures to encode by VA-API ({})", reason(code));
    context_->hw_frames_ctx = av_buffer_ref(frames.get());
    context_->pix_fmt = AV_PIX_FMT_VAAPI;
    uploaded_.reset(av_frame_alloc());
}

void PictureEncoder::add(const ColourImage& picture, std::int64_t number, bool is_key) {
    AVFrame* frame = &converter_->convert(picture);
    if (uploaded_) {
        av_frame_unref(uploaded_.get());
        int code = av_hwframe_get_buffer(context_->hw_frames_ctx, uploaded_.get(), 0);
        if (code >= 0) code = av_hwframe_transfer_data(uploaded_.get(), frame, 0);
        if (code < 0) fail("the encoder {} takes no picture ({})", name(), reason(code));
        frame = uploaded_.get();
    }
    frame->pts = number;
    frame->pict_type = is_key ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
    if (const int code = avcodec_send_frame(context_.get(), frame); code < 0)
        fail("the encoder {} fails ({})", name(), reason(code));
}

void PictureEncoder::end() {
    if (const int code = avcodec_send_frame(context_.get(), nullptr); code < 0)
        fail("the encoder {} does not end ({})", name(), reason(code));
}

AVPacket* PictureEncoder::next() {
    const int code = avcodec_receive_packet(context_.get(), packet_.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return nullptr;
    if (code < 0) fail("the encoder {} fails ({})", name(), reason(code));
    return packet_.get();
}

std::string choose_encoder(const std::string& request, const EncoderSettings& settings) {
    std::vector<std::string> names = known_encoders();
    if (!request.empty()) {
        require_known_encoder(request);
        names = {request};
    }
    const ColourImage picture(settings.height_px, settings.width_px, cv::Vec4b(90, 90, 90, 255));
    std::vector<std::string> refusals;
    for (const std::string& name : names) {
        try {
            PictureEncoder encoder(name, settings);
            constexpr int pictures = 3;
            int packets = 0;
            const auto count = [&] {
                while (encoder.next()) ++packets;
            };
            for (int i = 0; i < pictures; ++i) {
                encoder.add(picture, i);
                count();
            }
            encoder.end();
            count();
            if (packets != pictures)
                fail("the encoder {} made {} pictures of {}", name, packets, pictures);
            if (refusals.empty())
                log_info("pictures are encoded by {}", name);
            else
                log_info("pictures are encoded by {}; tried before it: {}", name,
                         fmt::join(refusals, "; "));
            return name;
        } catch (const Error& error) {
            refusals.push_back(fmt::format("{}: {}", name, error.what()));
        }
    }
    fail("no encoder can be used here: {}", fmt::join(refusals, "; "));
}

}  // namespace vantage
