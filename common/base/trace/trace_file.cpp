#include "common/base/trace/trace_file.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/output_path.h"
#include "common/base/files/unique_fd.h"
#include "common/base/log.h"
#include "common/base/this_thread.h"
#include "common/base/trace/trace.h"

namespace vantage {
namespace {

/// Name that name_trace_track() gave this thread; empty: none.
thread_local std::string track_name;

std::string name_of_this_thread() { return track_name.empty() ? this_thread_name() : track_name; }

/// The spans of one thread that wait for the file. Its thread pushes, the file's thread pops.
class Ring {
  public:
    explicit Ring(std::size_t capacity)
        : thread_id(::gettid()), name(name_of_this_thread()), events_(capacity) {}

    void push(const TraceEvent& event) {
        const std::uint64_t end = end_.load(std::memory_order_relaxed);
        if (end - begin_.load(std::memory_order_acquire) == events_.size()) {
            dropped_.fetch_add(1, std::memory_order_relaxed);
            return;
        }
        events_[end % events_.size()] = event;
        end_.store(end + 1, std::memory_order_release);
    }
    bool pop(TraceEvent& event) {
        const std::uint64_t begin = begin_.load(std::memory_order_relaxed);
        if (begin == end_.load(std::memory_order_acquire)) return false;
        event = events_[begin % events_.size()];
        begin_.store(begin + 1, std::memory_order_release);
        return true;
    }
    /// Spans that found no room since the last call.
    std::uint64_t take_dropped() {
        const std::uint64_t all = dropped_.load(std::memory_order_relaxed);
        return all - std::exchange(told_, all);
    }

    const int thread_id;
    const std::string name;

  private:
    std::vector<TraceEvent> events_;
    std::atomic<std::uint64_t> begin_ = 0, end_ = 0, dropped_ = 0;
    std::uint64_t told_ = 0;  ///< used by the file's thread
};

/// The rings of the present recording. A thread adds its own at its first span.
struct Rings {
    std::mutex mutex;
    std::vector<std::shared_ptr<Ring>> all;    ///< guarded by mutex
    std::size_t capacity = 1;                  ///< guarded by mutex
    std::atomic<std::uint64_t> recording = 0;  ///< number of the present recording
};
Rings& rings() {
    static Rings rings;
    return rings;
}

struct OwnRing {
    std::shared_ptr<Ring> ring;
    std::uint64_t recording = 0;
};
thread_local OwnRing own;

std::string quoted(const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Microseconds, the unit of the format, to the nanosecond.
std::string as_us(std::int64_t ns) { return fmt::format("{}.{:03}", ns / 1000, ns % 1000); }

}  // namespace

namespace trace_detail {

void record(const TraceEvent& event) {
    Rings& all = rings();
    const std::uint64_t recording = all.recording.load(std::memory_order_acquire);
    if (!own.ring || own.recording != recording) {
        const std::lock_guard lock(all.mutex);
        own = {std::make_shared<Ring>(all.capacity), recording};
        all.all.push_back(own.ring);
    }
    own.ring->push(event);
}

}  // namespace trace_detail

void name_trace_track(const std::string& name) { track_name = name; }

struct TraceFile::Impl {
    Impl(std::filesystem::path file_path, const std::string& program, bool overwrites,
         const Limits& set_limits)
        : path(std::move(file_path)), limits(set_limits) {
        require_writable_output(path, {});
        const int mode = overwrites ? O_TRUNC : O_EXCL;
        file = UniqueFd(::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | mode, 0644));
        if (file.get() < 0 && errno == EEXIST)
            fail(
                "{} is there already, and a trace is not replaced without being asked: take "
                "another name, or --overwrite",
                path.string());
        if (file.get() < 0) fail("cannot write {}: {}", path.string(), std::strerror(errno));
        // Every later event begins with a comma, so that a bracket completes the file at any time.
        text = fmt::format(
            R"([{{"ph":"M","name":"process_name","pid":{},"tid":0,"args":{{"name":{}}}}})", pid,
            quoted(program));
        write();
        if (!failure.empty()) fail("cannot write {}: {}", path.string(), failure);
        {
            const std::lock_guard lock(rings().mutex);
            rings().all.clear();
            rings().capacity = std::max<std::size_t>(1, limits.spans_per_thread);
            rings().recording.fetch_add(1, std::memory_order_acq_rel);
        }
        trace_detail::is_recording = true;
        thread = std::thread([this] { run(); });
    }

    ~Impl() {
        trace_detail::is_recording = false;
        {
            const std::lock_guard lock(mutex);
            is_ending = true;
        }
        woken.notify_all();
        thread.join();
        report();
    }

    void run() {
        name_this_thread("trace");
        for (;;) {
            bool is_last = false;
            {
                std::unique_lock lock(mutex);
                is_last = woken.wait_for(lock, limits.period, [this] { return is_ending; });
            }
            std::vector<std::shared_ptr<Ring>> all;
            {
                const std::lock_guard lock(rings().mutex);
                all = rings().all;
            }
            for (const std::shared_ptr<Ring>& ring : all) take(*ring);
            if (is_last) {
                text += "\n]\n";
                write();
                return;
            }
            write();
            forget_ended(std::move(all));
        }
    }

    /// Releases the rings of threads that have ended; nobody else holds them.
    void forget_ended(std::vector<std::shared_ptr<Ring>> all) {
        all.clear();
        const std::lock_guard lock(rings().mutex);
        std::erase_if(rings().all, [this](const std::shared_ptr<Ring>& ring) {
            if (ring.use_count() > 1) return false;
            // The thread may have pushed its last spans after take().
            take(*ring);
            return true;
        });
    }

    void take(Ring& ring) {
        if (std::string& name = tracks[ring.thread_id]; name != ring.name) {
            name = ring.name;
            text += fmt::format(
                R"(,{}{{"ph":"M","name":"thread_name","pid":{},"tid":{},"args":{{"name":{}}}}})",
                '\n', pid, ring.thread_id, quoted(ring.name));
        }
        TraceEvent event;
        while (ring.pop(event)) {
            if (is_full) {
                ++left_out;
            } else {
                add(event, ring.thread_id);
                ++written;
            }
        }
        if (const std::uint64_t more = ring.take_dropped(); more > 0) {
            lost[ring.name] += more;
            dropped += more;
        }
        constexpr std::size_t enough = 1 << 20;
        if (text.size() > enough) write();
    }

    void add(const TraceEvent& event, int thread_id) {
        const std::string place = fmt::format(R"("pid":{},"tid":{})", pid, thread_id);
        const std::string begin = as_us(event.begin_ns);
        text += fmt::format(R"(,{}{{"ph":"X","name":"{}",{},"ts":{},"dur":{})", '\n', event.name,
                            place, begin, as_us(event.length_ns));
        if (event.value_name)
            text += fmt::format(R"(,"args":{{"{}":{}}})", event.value_name, event.value);
        text += '}';
        for (const TraceEvent::Flow& flow : event.flows)
            if (flow.id != 0)
                text += fmt::format(
                    R"(,{}{{"ph":"{}","bp":"e","cat":"flow","name":"flow","id":"{:#x}",{},"ts":{}}})",
                    '\n', static_cast<char>(flow.place), flow.id, place, begin);
    }

    void write() {
        if (!failure.empty()) return text.clear();
        std::string_view rest = text;
        while (!rest.empty()) {
            const ssize_t count = ::write(file.get(), rest.data(), rest.size());
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) {
                failure = std::strerror(errno);
                is_full = true;
                log_error("the trace {} ends early, and the programme goes on: {}", path.string(),
                          failure);
                break;
            }
            rest.remove_prefix(static_cast<std::size_t>(count));
            bytes += static_cast<std::uint64_t>(count);
        }
        text.clear();
        if (bytes < limits.file_bytes || std::exchange(is_full, true)) return;
        log_warning("the trace {} has reached its largest size of {} MB; it ends here",
                    path.string(), limits.file_bytes / 1'000'000);
    }

    void report() const {
        log_info("the trace {} has {} spans", path.string(), written.load());
        if (left_out > 0)
            log_warning("{} spans came after the end of the trace {}", left_out, path.string());
        if (lost.empty()) return;
        std::vector<std::string> names;
        for (const auto& [name, count] : lost) names.push_back(fmt::format("{} {}", name, count));
        log_warning(
            "the trace {} lacks {} spans that came faster than they were written, by thread: {}",
            path.string(), dropped.load(), fmt::join(names, ", "));
    }

    const std::filesystem::path path;
    const Limits limits;
    const int pid = ::getpid();
    UniqueFd file;
    std::atomic<std::uint64_t> written = 0, dropped = 0;
    std::mutex mutex;
    std::condition_variable woken;
    bool is_ending = false;  ///< guarded by mutex

    // Used by the constructor, then by the thread, then by the destructor.
    std::string text;  ///< not written yet
    std::string failure;
    std::uint64_t bytes = 0, left_out = 0;
    bool is_full = false;
    std::map<int, std::string> tracks;          ///< names by thread
    std::map<std::string, std::uint64_t> lost;  ///< dropped spans by the name of the track
    std::thread thread;
};

TraceFile::TraceFile(std::filesystem::path path, const std::string& program, bool overwrites)
    : TraceFile(std::move(path), program, overwrites, Limits()) {}

TraceFile::TraceFile(std::filesystem::path path, const std::string& program, bool overwrites,
                     Limits limits)
    : impl_(std::make_unique<Impl>(std::move(path), program, overwrites, limits)) {}

TraceFile::~TraceFile() = default;

std::uint64_t TraceFile::written() const { return impl_->written; }

std::uint64_t TraceFile::dropped() const { return impl_->dropped; }

}  // namespace vantage
