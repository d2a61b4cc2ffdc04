#include "host_app/output/output.h"

#include <algorithm>
#include <utility>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/this_thread.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"
#include "common/base/trace/trace.h"

namespace vantage {
namespace {

/// Queue length in frames. It covers a stall of encoder, disk or peer; a frame of 1280x720 takes
/// 3.7 MB, which outputs share.
constexpr std::size_t most_waiting = 8;
/// Highest rate with a time code. Above it, one code counts several frames, and a reader would get
/// a wrong time.
constexpr double most_numbers_a_second = 60;
/// Frames that an encoder may hold back before they count as lost.
constexpr std::size_t most_encoding = 64;
/// All outputs encode right after a tick, which is when the next picture begins. An encoder has the
/// whole tick for it, and the picture has not.
constexpr int encoder_niceness = 5;
/// Pause before a failed stream is tried again: the first and the longest one.
constexpr std::chrono::milliseconds first_rest{500}, longest_rest{10'000};
/// Time for a peer to take the waiting frames when an output ends.
constexpr std::chrono::seconds last_words{2};
constexpr std::chrono::milliseconds look_period{50};
/// Longest sound that waits.
constexpr double longest_sound_s = 2;

/// The place of an output among the sinks of its encoder.
class EncoderSeat {
  public:
    EncoderSeat(SharedEncoder* encoder, EncodedSink& sink) : encoder_(encoder), sink_(sink) {
        if (encoder_) encoder_->join(sink_);
    }
    ~EncoderSeat() {
        if (encoder_) encoder_->leave(sink_);
    }
    EncoderSeat(const EncoderSeat&) = delete;
    EncoderSeat& operator=(const EncoderSeat&) = delete;

  private:
    SharedEncoder* encoder_;
    EncodedSink& sink_;
};

}  // namespace

Output::Output(OutputPlan plan, const OutputFormat& format, double pulse_rate_hz)
    : plan_(std::move(plan)),
      queue_(most_waiting),
      most_sounds_(static_cast<std::size_t>(longest_sound_s * format.rate_hz) + 1) {
    if (PulseGrid(format.rate_hz).rate_hz() <= most_numbers_a_second)
        timecode_.emplace(pulse_rate_hz, format.rate_hz);
    state_.name = plan_.name;
    state_.film = plan_.film;
    if (plan_.is_encoded) state_.encoder = format.encoder;
    state_.has_sound = plan_.takes_sound;
    thread_ = std::thread([this] { run(); });
}

Output::~Output() {
    {
        const std::lock_guard lock(mutex_);
        is_abandoned_ = is_ending_ = true;
        is_wanted_ = false;
        patience_.ends_after({});
    }
    woken_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void Output::start() {
    {
        const std::lock_guard lock(mutex_);
        if (is_ending_) return;
        is_wanted_ = true;
        patience_.is_endless();
        if (state_.phase == OutputPhase::off || state_.phase == OutputPhase::failed) {
            state_.phase = OutputPhase::opening;
            state_.failure.clear();
            is_due_ = true;
        }
    }
    woken_.notify_all();
}

void Output::stop() {
    {
        const std::lock_guard lock(mutex_);
        want_no_more();
        // Whoever stops a failed stream has seen its failure.
        if (plan_.is_stream && state_.phase == OutputPhase::failed) {
            state_.phase = OutputPhase::off;
            state_.failure.clear();
        }
    }
    woken_.notify_all();
}

void Output::want_no_more() {
    is_wanted_ = false;
    patience_.ends_after(state_.phase == OutputPhase::on ? last_words : std::chrono::seconds(0));
}

void Output::take(const ProgrammePicture& picture) {
    const TraceSpan span("hand to output");
    std::string timecode = timecode_ && picture.set ? timecode_->of(*picture.set) : std::string();
    const std::lock_guard lock(mutex_);
    if (!is_wanted_) return;
    ++state_.offered;
    const bool waits_to_open = state_.phase == OutputPhase::opening && !plan_.is_stream;
    if (state_.phase != OutputPhase::on && !waits_to_open) {
        ++(plan_.is_stream ? state_.unheard : state_.dropped);
        return;
    }
    if (plan_.takes_sound && picture.sound) {
        sounds_.push_back({picture.tick, picture.sound});
        if (sounds_.size() > most_sounds_) {
            sounds_.pop_front();
            ++state_.silenced;
        }
    }
    if (!plan_.encoder) {
        if (queue_.push({picture.picture, picture.tick, std::move(timecode)})) ++state_.dropped;
        return;
    }
    encoding_.push_back(picture.tick);
    if (encoding_.size() > most_encoding) {
        encoding_.pop_front();
        ++state_.dropped;
    }
    plan_.encoder->offer(picture.picture, picture.tick);
    while (!early_.empty() && early_.front().tick <= picture.tick) {
        deliver(early_.front());
        early_.pop_front();
    }
}

void Output::take(const EncodedPicture& picture) {
    const std::lock_guard lock(mutex_);
    if (!encoding_.empty() && encoding_.back() >= picture.tick) return deliver(picture);
    // Another output has offered the frame, and the programme is about to offer it here.
    early_.push_back(picture);
    if (early_.size() > most_waiting) early_.pop_front();
}

void Output::deliver(const EncodedPicture& picture) {
    // The encoder could not follow and left these out.
    while (!encoding_.empty() && encoding_.front() < picture.tick) {
        encoding_.pop_front();
        ++state_.dropped;
    }
    // A frame of other outputs, from before this one was open.
    if (encoding_.empty() || encoding_.front() != picture.tick) return;
    encoding_.pop_front();
    if (!picture.is_key && picture.number != next_number_) awaits_key_ = true;
    next_number_ = picture.number + 1;
    if (awaits_key_ && !picture.is_key) {
        ++(has_begun_ ? state_.dropped : state_.unheard);
        // Key frames cost all outputs bits, so one that hangs asks for none.
        const std::uint64_t held =
            state_.offered - state_.pictures - state_.dropped - state_.unheard - encoding_.size();
        if (held == 0) plan_.encoder->request_key();
        return;
    }
    if (queue_.size() == most_waiting) {
        ++state_.dropped;
        return wait_for_key();
    }
    awaits_key_ = false;
    has_begun_ = true;
    (void)queue_.push({{}, picture.tick, {}, picture});
}

void Output::wait_for_key() {
    while (queue_.pop_for({})) ++state_.dropped;
    awaits_key_ = true;
}

void Output::note_encoder_failure(const std::string& sentence) {
    const std::lock_guard lock(mutex_);
    encoder_failure_ = sentence;
}

bool Output::is_being_encoded() const {
    const std::lock_guard lock(mutex_);
    return !encoding_.empty() && encoder_failure_.empty();
}

void Output::finish() {
    {
        const std::lock_guard lock(mutex_);
        want_no_more();
        is_ending_ = true;
    }
    woken_.notify_all();
    if (thread_.joinable()) thread_.join();
}

OutputState Output::state() const {
    const std::lock_guard lock(mutex_);
    OutputState state = state_;
    state.queued = state.offered - state.pictures - state.dropped - state.unheard;
    state.write_ms = write_ms_.summary();
    return state;
}

bool Output::is_wanted() const {
    const std::lock_guard lock(mutex_);
    return is_wanted_;
}

void Output::run() {
    name_this_thread("output");
    name_trace_track("output " + plan_.name);
    // The encoder and its threads, which begin here, follow the picture that is being rendered.
    if (plan_.is_encoded) make_this_thread_nice(encoder_niceness);
    std::chrono::nanoseconds rest = first_rest;
    for (;;) {
        {
            std::unique_lock lock(mutex_);
            woken_.wait(lock, [this] { return is_due_ || is_ending_; });
            if (!is_due_) return;
            is_due_ = false;
        }
        const std::uint64_t before = state().pictures;
        try {
            serve();
            rest = first_rest;
        } catch (const CallerLeft&) {
            note_caller_left();
            rest = first_rest;
        } catch (const std::exception& error) {
            note_failure(error.what());
            if (state().pictures > before) rest = first_rest;
            if (wait_to_try_again(rest))
                rest = std::min<std::chrono::nanoseconds>(2 * rest, longest_rest);
        }
    }
}

void Output::serve() {
    {
        const std::lock_guard lock(mutex_);
        if (plan_.is_listening) state_.phase = OutputPhase::waiting;
    }
    first_tick_.reset();
    std::unique_ptr<OutputTarget> target = plan_.open(patience_);
    const EncoderSeat seat(plan_.encoder.get(), *this);
    {
        const std::lock_guard lock(mutex_);
        encoding_.clear();
        early_.clear();
        encoder_failure_.clear();
        awaits_key_ = true;
        has_begun_ = false;
        state_.phase = OutputPhase::on;
        state_.failure.clear();
        bytes_before_ = state_.bytes;
    }
    log_info("{}: {}", plan_.name, words_of(OutputPhase::on));
    try {
        write_all(*target);
        if (is_abandoned_) return;
        target->finish();
    } catch (const CallerLeft&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(error.what() + target->salvage());
    }
    const std::lock_guard lock(mutex_);
    // The encoder has not delivered these in time.
    state_.dropped += encoding_.size();
    encoding_.clear();
    state_.bytes = bytes_before_ + target->bytes();
    state_.bit_rate_bps = 0;
    is_due_ = is_wanted_;
    state_.phase = is_wanted_ ? OutputPhase::opening : OutputPhase::off;
    log_info("{}: ended", plan_.name);
}

void Output::write_all(OutputTarget& target) {
    if (plan_.encoder) plan_.encoder->request_key();
    bool is_flushed = false;
    for (;;) {
        // Read before the queue, which a frame enters when it leaves the encoder.
        const bool is_last = !is_wanted() && !is_being_encoded();
        if (const std::optional<Item> item = queue_.pop_for(look_period)) {
            write(target, *item);
            while (queue_.size() == 0 && target.catch_up())
                ;
            continue;
        }
        {
            const std::lock_guard lock(mutex_);
            if (!encoder_failure_.empty()) fail("{}", encoder_failure_);
        }
        if (is_last) return;
        if (is_wanted() || !plan_.encoder) continue;
        if (patience_.is_over()) return;
        if (!std::exchange(is_flushed, true)) plan_.encoder->flush_for(*this);
    }
}

void Output::write(OutputTarget& target, const Item& item) {
    TraceSpan span("encode and write");
    span.with("tick", static_cast<std::int64_t>(item.tick))
        .in(TraceId::of_tick(item.tick), TraceFlow::passes);
    if (!first_tick_) first_tick_ = item.tick;
    const MonotonicTime start = MonotonicClock::now();
    if (item.tick > *first_tick_) hear(target, item.tick - 1);
    const auto tick = static_cast<std::int64_t>(item.tick - *first_tick_);
    if (item.encoded)
        target.write_encoded(*item.encoded, tick);
    else
        target.write(item.picture, tick, item.timecode);
    hear(target, item.tick);
    const MonotonicTime end = MonotonicClock::now();
    const std::lock_guard lock(mutex_);
    write_ms_.add(to_ms(end - start) + (item.encoded ? item.encoded->encode_ms : 0));
    ++state_.pictures;
    state_.bytes = bytes_before_ + target.bytes();
    bytes_rate_.add(state_.bytes, end);
    constexpr double bits = 8;
    state_.bit_rate_bps = bits * bytes_rate_.per_second();
}

void Output::hear(OutputTarget& target, std::uint64_t until) {
    for (;;) {
        Sound sound;
        {
            const std::lock_guard lock(mutex_);
            if (sounds_.empty() || sounds_.front().tick > until) return;
            sound = std::move(sounds_.front());
            sounds_.pop_front();
        }
        if (sound.tick < *first_tick_) continue;
        target.hear(*sound.block, static_cast<std::int64_t>(sound.tick - *first_tick_));
    }
}

void Output::drop_waiting() {
    while (queue_.pop_for({}))
        ;
    encoding_.clear();
    early_.clear();
    sounds_.clear();
    state_.dropped = state_.offered - state_.pictures - state_.unheard;
    state_.bit_rate_bps = 0;
}

void Output::note_caller_left() {
    const std::lock_guard lock(mutex_);
    drop_waiting();
    ++state_.callers_left;
    state_.failure.clear();
    state_.phase = is_wanted_ ? OutputPhase::opening : OutputPhase::off;
    is_due_ = is_wanted_;
    log_info("{}: its caller has left{}", plan_.name,
             is_wanted_ ? "; the next one is waited for" : "");
}

void Output::note_failure(const std::string& sentence) {
    const std::lock_guard lock(mutex_);
    drop_waiting();
    // A stream that is stopped before it was connected has not failed.
    if (plan_.is_stream && !is_wanted_ && state_.phase != OutputPhase::on) {
        // A stream that waits for a caller is listening, so that its earlier failure is over.
        if (state_.phase == OutputPhase::waiting) state_.failure.clear();
        state_.phase = state_.failure.empty() ? OutputPhase::off : OutputPhase::failed;
        return;
    }
    if (state_.failure != sentence)
        log_error("{} fails, and the programme goes on: {}", plan_.name, sentence);
    state_.phase = OutputPhase::failed;
    state_.failure = sentence;
    ++state_.failures;
    if (!plan_.is_stream) is_wanted_ = false;
}

bool Output::wait_to_try_again(std::chrono::nanoseconds time) {
    std::unique_lock lock(mutex_);
    woken_.wait_for(lock, time, [this] { return !is_wanted_; });
    is_due_ = is_wanted_;
    return is_due_;
}

const char* key_of(OutputPhase phase) {
    switch (phase) {
        case OutputPhase::off:
            break;
        case OutputPhase::opening:
            return "opening";
        case OutputPhase::waiting:
            return "waiting";
        case OutputPhase::on:
            return "on";
        case OutputPhase::failed:
            return "failed";
    }
    return "off";
}

const char* words_of(OutputPhase phase) {
    if (phase == OutputPhase::waiting) return "waiting for a caller";
    return phase == OutputPhase::failed ? "FAILED" : key_of(phase);
}

}  // namespace vantage
