#include "host_app/output/media/shared_encoder.h"

#include <algorithm>
#include <utility>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/this_thread.h"
#include "common/base/time/time.h"
#include "common/base/trace/trace.h"

namespace vantage {
namespace {

/// Frames that wait for the encoder; as many as wait for an output.
constexpr std::size_t most_offers = 8;
/// How long the thread sleeps at most, so that it notices a request to flush.
constexpr std::chrono::milliseconds flush_period{20};
/// Shortest time between two key frames that sinks ask for: each costs the bits of several others.
constexpr double least_key_period_s = 0.5;

std::shared_ptr<const AVPacket> shared_copy(const AVPacket& packet) {
    std::shared_ptr<AVPacket> copy(av_packet_clone(&packet),
                                   [](AVPacket* each) { av_packet_free(&each); });
    if (!copy) fail("memory is short");
    return copy;
}

}  // namespace

SharedEncoder::SharedEncoder(std::string encoder, const EncoderSettings& settings)
    : encoder_name_(std::move(encoder)), settings_(settings), offers_(most_offers) {}

SharedEncoder::~SharedEncoder() {
    offers_.close();
    const std::lock_guard lock(thread_mutex_);
    if (thread_.joinable()) thread_.join();
}

SharedEncoder::Use::Use(std::shared_ptr<SharedEncoder> encoder) : encoder_(std::move(encoder)) {
    const std::lock_guard lock(encoder_->encoder_mutex_);
    if (!encoder_->open_) encoder_->open_.emplace(encoder_->encoder_name_, encoder_->settings_);
    const AVCodecContext& context = encoder_->open_->context();
    time_base_ = context.time_base;
    rate_ = context.framerate;
    parameters_.reset(avcodec_parameters_alloc());
    if (!parameters_ || avcodec_parameters_from_context(parameters_.get(), &context) < 0)
        fail("memory is short");
    ++encoder_->uses_;
}

SharedEncoder::Use::~Use() {
    const std::lock_guard lock(encoder_->encoder_mutex_);
    if (--encoder_->uses_ == 0) encoder_->open_.reset();
}

void SharedEncoder::join(EncodedSink& sink) {
    std::size_t count = 0;
    {
        wants_flush_ = false;
        const std::lock_guard lock(sinks_mutex_);
        sinks_.push_back(&sink);
        count = sinks_.size();
    }
    if (count > 1) log_info("{} outputs share one encoder ({})", count, encoder_name_);
    const std::lock_guard lock(thread_mutex_);
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
}

void SharedEncoder::leave(EncodedSink& sink) {
    const std::lock_guard lock(sinks_mutex_);
    std::erase(sinks_, &sink);
}

std::size_t SharedEncoder::sinks() const {
    const std::lock_guard lock(sinks_mutex_);
    return sinks_.size();
}

void SharedEncoder::offer(const ColourImage& picture, std::uint64_t tick) {
    const std::lock_guard lock(offer_mutex_);
    if (offered_ && tick <= *offered_) return;
    offered_ = tick;
    (void)offers_.push({picture, tick});
}

void SharedEncoder::request_key() { wants_key_ = true; }

void SharedEncoder::flush_for(const EncodedSink& sink) {
    const std::lock_guard lock(sinks_mutex_);
    if (sinks_.size() == 1 && sinks_.front() == &sink) wants_flush_ = true;
}

void SharedEncoder::flush() { wants_flush_ = true; }

void SharedEncoder::run() {
    name_this_thread("encoder");
    while (!offers_.closed()) {
        const std::optional<Offer> offer = offers_.pop_for(flush_period);
        const std::lock_guard lock(encoder_mutex_);
        try {
            if (offer && uses_ > 0) encode(*offer);
            if (!offer && wants_flush_.exchange(false)) flush_encoder();
        } catch (const std::exception& error) {
            open_.reset();
            fail_all(error.what());
        }
    }
}

void SharedEncoder::encode(const Offer& offer) {
    TraceSpan span("encode");
    span.with("tick", static_cast<std::int64_t>(offer.tick))
        .in(TraceId::of_tick(offer.tick), TraceFlow::passes);
    const MonotonicTime start = MonotonicClock::now();
    if (!open_) open_.emplace(encoder_name_, settings_);
    const double least_ticks = least_key_period_s * settings_.rate_hz;
    const bool may_be_key =
        !last_key_tick_ || static_cast<double>(offer.tick - *last_key_tick_) >= least_ticks;
    const bool is_key = may_be_key && wants_key_.exchange(false);
    open_->add(offer.picture, static_cast<std::int64_t>(offer.tick), is_key);
    encode_ms_ = ms_since(start);
    pass_on();
}

void SharedEncoder::flush_encoder() {
    if (!open_) return;
    open_->end();
    encode_ms_ = 0;
    pass_on();
    open_.reset();
}

void SharedEncoder::pass_on() {
    while (const AVPacket* packet = open_->next()) {
        EncodedPicture picture;
        picture.packet = shared_copy(*packet);
        picture.tick = static_cast<std::uint64_t>(packet->pts);
        picture.number = encoded_++;
        picture.is_key = (packet->flags & AV_PKT_FLAG_KEY) != 0;
        picture.encode_ms = encode_ms_;
        if (picture.is_key) {
            last_key_tick_ = picture.tick;
            wants_key_ = false;
        }
        const std::lock_guard lock(sinks_mutex_);
        for (EncodedSink* sink : sinks_) sink->take(picture);
    }
}

void SharedEncoder::fail_all(const std::string& sentence) {
    const std::lock_guard lock(sinks_mutex_);
    for (EncodedSink* sink : sinks_) sink->note_encoder_failure(sentence);
}

std::shared_ptr<SharedEncoder> EncoderPool::find(const std::string& encoder,
                                                 const EncoderSettings& settings) {
    const std::lock_guard lock(mutex_);
    std::erase_if(encoders_, [](const auto& each) { return each.expired(); });
    for (const std::weak_ptr<SharedEncoder>& each : encoders_) {
        std::shared_ptr<SharedEncoder> known = each.lock();
        if (known && known->encoder() == encoder && known->settings() == settings) return known;
    }
    auto made = std::make_shared<SharedEncoder>(encoder, settings);
    encoders_.push_back(made);
    return made;
}

std::uint64_t EncoderPool::encoded() const {
    const std::lock_guard lock(mutex_);
    std::uint64_t encoded = 0;
    for (const std::weak_ptr<SharedEncoder>& each : encoders_)
        if (const std::shared_ptr<SharedEncoder> encoder = each.lock())
            encoded += encoder->encoded();
    return encoded;
}

void EncoderPool::flush() {
    const std::lock_guard lock(mutex_);
    for (const std::weak_ptr<SharedEncoder>& each : encoders_)
        if (const std::shared_ptr<SharedEncoder> encoder = each.lock()) encoder->flush();
}

}  // namespace vantage
