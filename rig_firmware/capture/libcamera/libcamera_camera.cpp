#include "rig_firmware/capture/libcamera/libcamera_camera.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <thread>
#include <utility>

#include <fnmatch.h>
#include <libcamera/libcamera.h>
#include <sys/mman.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"
#include "common/wire/wake_event.h"
#include "rig_firmware/capture/buffer_lender.h"
#include "rig_firmware/capture/camera_access.h"
#include "rig_firmware/capture/device_lost.h"
#include "rig_firmware/capture/dma_buf_access.h"
#include "rig_firmware/capture/pixel_conversion.h"

namespace vantage {
namespace {

/// libcamera's names of the supported pixel formats, in order of preference.
struct KnownFormat {
    libcamera::PixelFormat theirs;
    PixelFormat ours;
};
const std::vector<KnownFormat>& known_formats() {
    static const std::vector<KnownFormat> formats = {
        {libcamera::formats::YUYV, PixelFormat::yuyv},
        {libcamera::formats::NV12, PixelFormat::nv12},
        {libcamera::formats::R8, PixelFormat::grey},
        {libcamera::formats::R10, PixelFormat::y10},
        {libcamera::formats::R16, PixelFormat::y16},
        {libcamera::formats::MJPEG, PixelFormat::mjpg}};
    return formats;
}

std::string model_of(const libcamera::Camera& camera) {
    return camera.properties().get(libcamera::properties::Model).value_or(std::string());
}

std::shared_ptr<libcamera::Camera> find_camera(const libcamera::CameraManager& manager,
                                               const std::string& pattern) {
    std::vector<std::shared_ptr<libcamera::Camera>> fitting;
    std::string listed;
    for (const std::shared_ptr<libcamera::Camera>& camera : manager.cameras()) {
        const std::string model = model_of(*camera);
        listed += fmt::format("{}'{}' ({})", listed.empty() ? "" : ", ", camera->id(), model);
        // An exact id goes before a pattern, since ids may contain brackets.
        if (camera->id() == pattern) return camera;
        if (::fnmatch(pattern.c_str(), camera->id().c_str(), 0) == 0 ||
            ::fnmatch(pattern.c_str(), model.c_str(), 0) == 0)
            fitting.push_back(camera);
    }
    if (fitting.size() == 1) return fitting.front();
    if (fitting.empty()) {
        const std::string forbidden = forbidden_camera();
        throw DeviceLost(fmt::format("libcamera has no camera '{}'; there {}{}", pattern,
                                     listed.empty() ? "is none" : "are: " + listed,
                                     forbidden.empty() ? "" : "; and " + forbidden));
    }
    fail("'{}' fits {} cameras of libcamera: name one more closely; there are: {}", pattern,
         fitting.size(), listed);
}

/// Memory mapping of all planes of one buffer, as one piece.
class MappedBuffer {
  public:
    explicit MappedBuffer(const libcamera::FrameBuffer& buffer) {
        const auto& planes = buffer.planes();
        fd_ = planes.front().fd.get();
        std::size_t end = 0;
        for (const libcamera::FrameBuffer::Plane& plane : planes) {
            if (plane.fd.get() != fd_ || (end != 0 && plane.offset != end))
                fail(
                    "a camera delivers the planes of a picture in separate memory; choose "
                    "another 'pixel_format' in [source]");
            end = plane.offset + plane.length;
        }
        begin_ = planes.front().offset;
        length_ = end;
        void* start = ::mmap(nullptr, length_, PROT_READ, MAP_SHARED, fd_, 0);
        if (start == MAP_FAILED) fail("a camera's buffer of {} bytes cannot be mapped", length_);
        start_ = static_cast<std::byte*>(start);
    }
    ~MappedBuffer() { ::munmap(start_, length_); }
    MappedBuffer(const MappedBuffer&) = delete;
    MappedBuffer& operator=(const MappedBuffer&) = delete;

    int fd() const { return fd_; }
    std::size_t begin() const { return begin_; }
    std::span<const std::byte> bytes() const { return {start_ + begin_, length_ - begin_}; }

  private:
    int fd_ = -1;
    std::byte* start_ = nullptr;
    std::size_t begin_ = 0, length_ = 0;
};

/// Kernel devices of a camera. libcamera learns from udev, with some delay, that they are gone; it
/// aborts the process (at least versions 0.3 to 0.7) if a camera is stopped or given a buffer in
/// between.
class KernelDevices {
  public:
    explicit KernelDevices(const libcamera::Camera& camera) {
        const auto numbers = camera.properties().get(libcamera::properties::SystemDevices);
        if (!numbers) return;
        for (const std::int64_t number : *numbers) {
            const auto device = static_cast<dev_t>(number);
            entries_.push_back(fmt::format("/sys/dev/char/{}:{}", major(device), minor(device)));
        }
    }
    bool are_there() const {
        return std::all_of(entries_.begin(), entries_.end(), [](const std::string& entry) {
            return ::access(entry.c_str(), F_OK) == 0;
        });
    }

  private:
    std::vector<std::string> entries_;
};

/// Work that runs on libcamera's own thread.
class Errand : public libcamera::Object {
  public:
    /// Runs `work` on libcamera's thread and waits until it is done.
    static void run(libcamera::Camera& camera, std::function<void()> work) {
        const auto end_there = [](Errand* errand) { errand->deleteLater(); };
        const std::unique_ptr<Errand, decltype(end_there)> errand(
            new Errand(camera, std::move(work)));
        errand->invokeMethod(&Errand::work, libcamera::ConnectionTypeBlocking);
    }

  private:
    Errand(libcamera::Camera& camera, std::function<void()> work)
        : Object(&camera), work_(std::move(work)) {}
    void work() { work_(); }

    std::function<void()> work_;
};

class LibcameraCamera final : public SensorCamera {
  public:
    LibcameraCamera(std::shared_ptr<libcamera::CameraManager> manager, const std::string& pattern,
                    const RigConfig::Source& settings, bool side_by_side)
        : manager_(std::move(manager)),
          camera_(find_camera(*manager_, pattern)),
          devices_(*camera_),
          lender_([this](unsigned index) { take_back(index); }) {
        if (camera_->acquire() != 0)
            throw DeviceLost(fmt::format(
                "camera '{}' is in use by another program: end that program", camera_->id()));
        try {
            configure(settings, side_by_side);
            start(settings);
        } catch (...) {
            shut();
            throw;
        }
    }

    ~LibcameraCamera() override { shut(); }

    int fd() const override { return ready_.fd(); }

    std::optional<SensorPicture> take() override {
        if (lost_) throw DeviceLost(fmt::format("camera '{}' is gone", camera_->id()));
        libcamera::Request* request = nullptr;
        {
            const std::lock_guard lock(mutex_);
            if (completed_.empty()) {
                ready_.clear();
                return std::nullopt;
            }
            request = completed_.front();
            completed_.pop_front();
        }
        std::optional<SensorPicture> picture = picture_of(*request);
        if (picture && picture->lent) return picture;
        if (!queue_again(*request))
            throw DeviceLost(fmt::format("camera '{}' takes no more buffers", camera_->id()));
        return picture;
    }

    std::optional<LentPicture> specimen() const override {
        if (format_ == PixelFormat::mjpg || requests_.size() < BufferLender::least_buffers)
            return std::nullopt;
        return lent(0, buffer_of(*requests_[0]).bytes());
    }

    void lend() override { lends_ = specimen().has_value(); }

    std::uint64_t damaged() const override { return damaged_; }
    std::vector<std::string> report() const override { return report_; }

  private:
    void configure(const RigConfig::Source& settings, bool side_by_side) {
        configuration_ = camera_->generateConfiguration({libcamera::StreamRole::VideoRecording});
        if (!configuration_ || configuration_->empty())
            fail("camera '{}' delivers no pictures", camera_->id());
        libcamera::StreamConfiguration& stream = configuration_->at(0);
        const libcamera::Size size(
            static_cast<unsigned>(settings.width_px * (side_by_side ? 2 : 1)),
            static_cast<unsigned>(settings.height_px));
        const std::vector<libcamera::PixelFormat> offered = stream.formats().pixelformats();
        for (const KnownFormat& known : known_formats()) {
            if (!settings.pixel_format.empty() &&
                parse_pixel_format(settings.pixel_format) != known.ours)
                continue;
            if (std::find(offered.begin(), offered.end(), known.theirs) == offered.end()) continue;
            stream.pixelFormat = known.theirs;
            stream.size = size;
            stream.stride = 0;
            stream.bufferCount = BufferLender::wanted_buffers;
            if (configuration_->validate() == libcamera::CameraConfiguration::Invalid ||
                stream.pixelFormat != known.theirs || stream.size != size)
                continue;
            if (camera_->configure(configuration_.get()) != 0)
                throw DeviceLost(fmt::format("camera '{}' refuses its mode", camera_->id()));
            format_ = known.ours;
            return;
        }
        std::string listed;
        for (const libcamera::PixelFormat& format : offered) {
            listed += " " + format.toString() + ":";
            for (const libcamera::Size& each : stream.formats().sizes(format))
                listed += " " + each.toString();
        }
        fail("camera '{}' does not deliver {}x{} in {}; it has:{}", camera_->id(), size.width,
             size.height, settings.pixel_format.empty() ? "a known format" : settings.pixel_format,
             listed);
    }

    void start(const RigConfig::Source& settings) {
        libcamera::Stream* stream = configuration_->at(0).stream();
        allocator_ = std::make_unique<libcamera::FrameBufferAllocator>(camera_);
        if (allocator_->allocate(stream) <= 0)
            fail("camera '{}' has no memory for its pictures", camera_->id());
        for (const std::unique_ptr<libcamera::FrameBuffer>& buffer : allocator_->buffers(stream)) {
            mappings_.emplace(buffer.get(), std::make_shared<const MappedBuffer>(*buffer));
            std::unique_ptr<libcamera::Request> request = camera_->createRequest(requests_.size());
            if (!request || request->addBuffer(stream, buffer.get()) != 0)
                fail("camera '{}' takes no buffers", camera_->id());
            requests_.push_back(std::move(request));
        }
        camera_->requestCompleted.connect(this, &LibcameraCamera::on_completed);
        camera_->disconnected.connect(this, &LibcameraCamera::on_disconnected);
        libcamera::ControlList controls = fixed_controls(settings);
        if (camera_->start(&controls) != 0)
            throw DeviceLost(fmt::format("camera '{}' does not start", camera_->id()));
        started_ = true;
        for (const std::unique_ptr<libcamera::Request>& request : requests_)
            if (camera_->queueRequest(request.get()) != 0)
                throw DeviceLost(fmt::format("camera '{}' takes no requests", camera_->id()));
        const libcamera::StreamConfiguration& mode = configuration_->at(0);
        report_.insert(
            report_.begin(),
            fmt::format("camera '{}' ({}): {} in lines of {} bytes, {} buffers{}", camera_->id(),
                        model_of(*camera_), mode.toString(), mode.stride, requests_.size(),
                        specimen() ? "" : ", every picture is converted on the processor"));
    }

    /// Controls for the configured exposure, gain and white balance. Logs each setting that the
    /// camera has no control for.
    libcamera::ControlList fixed_controls(const RigConfig::Source& settings) {
        namespace controls = libcamera::controls;
        libcamera::ControlList list(camera_->controls());
        std::string fixed, left_out;
        const auto fix = [&](const auto& control, const auto& value, const std::string& text) {
            const bool is_there = camera_->controls().count(&control) > 0;
            if (is_there) list.set(control, value);
            std::string& place = is_there ? fixed : left_out;
            place += (place.empty() ? "" : ", ") + text;
        };
        const double period_us = 1e6 / PulseGrid(settings.rate_hz).rate_hz();
        const auto period = static_cast<std::int64_t>(std::llround(period_us));
        fix(controls::AeEnable, false, "automatic exposure off");
        fix(controls::ExposureTime, static_cast<std::int32_t>(std::lround(settings.exposure_us)),
            fmt::format("exposure {:.0f} us", settings.exposure_us));
        fix(controls::AnalogueGain, static_cast<float>(settings.analogue_gain),
            fmt::format("gain {:.2f}", settings.analogue_gain));
        fix(controls::AwbEnable, false, "automatic white balance off");
        const std::array<float, 2> gains = {static_cast<float>(settings.red_gain),
                                            static_cast<float>(settings.blue_gain)};
        fix(controls::ColourGains, libcamera::Span<const float, 2>(gains),
            fmt::format("red gain {:.2f} and blue gain {:.2f}", settings.red_gain,
                        settings.blue_gain));
        const std::array<std::int64_t, 2> durations = {period, period};
        fix(controls::FrameDurationLimits, libcamera::Span<const std::int64_t, 2>(durations),
            fmt::format("period {} us", period));
        if (!fixed.empty())
            report_.push_back(fmt::format("camera '{}' is fixed: {}", camera_->id(), fixed));
        if (!left_out.empty())
            report_.push_back(
                fmt::format("camera '{}' has no control for: {}; it may drift in a "
                            "take",
                            camera_->id(), left_out));
        return list;
    }

    /// Called on libcamera's thread.
    void on_completed(libcamera::Request* request) {
        if (request->status() == libcamera::Request::RequestCancelled) return;
        {
            const std::lock_guard lock(mutex_);
            completed_.push_back(request);
        }
        ready_.notify();
    }
    void on_disconnected() {
        disconnected_ = true;
        lost_ = true;
        ready_.notify();
    }

    std::optional<SensorPicture> picture_of(libcamera::Request& request) {
        const libcamera::FrameBuffer& buffer = *request.buffers().begin()->second;
        const libcamera::FrameMetadata& metadata = buffer.metadata();
        if (metadata.status != libcamera::FrameMetadata::FrameSuccess) {
            ++damaged_;
            return std::nullopt;
        }
        const std::shared_ptr<const MappedBuffer>& mapping = mappings_.at(&buffer);
        std::span<const std::byte> bytes = mapping->bytes();
        if (format_ == PixelFormat::mjpg)
            bytes =
                bytes.first(std::min<std::size_t>(bytes.size(), metadata.planes()[0].bytesused));
        // The sensor's own time stamp if the pipeline has one, else the driver's time stamp of the
        // buffer.
        const auto sensor_time = request.metadata().get(libcamera::controls::SensorTimestamp);
        try {
            SensorPicture picture{.sequence = metadata.sequence,
                                  .time = monotonic_from_ns(sensor_time.value_or(
                                      static_cast<std::int64_t>(metadata.timestamp))),
                                  .colour = {},
                                  .lent = {}};
            const auto index = static_cast<unsigned>(request.cookie());
            LentPicture whole = lent(index, bytes);
            if (lends_) {
                (void)planes_of(whole.raw);
                whole.lease = lender_.lend(index, mapping);
                picture.lent = std::move(whole);
                return picture;
            }
            const DmaBufAccess access(mapping->fd());
            picture.colour = to_colour(whole.raw);
            return picture;
        } catch (const Error&) {
            ++damaged_;
            return std::nullopt;
        }
    }

    const MappedBuffer& buffer_of(const libcamera::Request& request) const {
        return *mappings_.at(request.buffers().begin()->second);
    }

    LentPicture lent(unsigned index, std::span<const std::byte> bytes) const {
        const libcamera::StreamConfiguration& mode = configuration_->at(0);
        const int width = static_cast<int>(mode.size.width);
        const int height = static_cast<int>(mode.size.height);
        const MappedBuffer& mapping = buffer_of(*requests_.at(index));
        return {.raw = {.format = format_,
                        .width_px = width,
                        .height_px = height,
                        .bytes_per_line = mode.stride,
                        .bytes = bytes},
                .view = {0, 0, width, height},
                .dma_buf = mapping.fd(),
                .offset = mapping.begin(),
                .camera = lender_.identity(),
                .index = index,
                .lease = {}};
    }

    /// Any thread; libcamera's queue is thread-safe.
    void take_back(unsigned index) noexcept {
        if (queue_again(*requests_[index])) return;
        lost_ = true;
        ready_.notify();
    }
    bool queue_again(libcamera::Request& request) const {
        request.reuse(libcamera::Request::ReuseBuffers);
        return devices_.are_there() && camera_->queueRequest(&request) == 0;
    }

    void shut() {
        lender_.close();
        if (!devices_.are_there())
            await_disconnection();
        else if (started_)
            camera_->stop();
        // libcamera's thread may still have queued calls that use these requests and slots.
        Errand::run(*camera_, [this] {
            camera_->requestCompleted.disconnect(this);
            camera_->disconnected.disconnect(this);
            requests_.clear();
        });
        mappings_.clear();
        allocator_.reset();
        camera_->release();
    }

    void await_disconnection() const {
        constexpr std::chrono::seconds longest(2);
        const MonotonicTime end = MonotonicClock::now() + longest;
        while (!disconnected_ && MonotonicClock::now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }

    std::shared_ptr<libcamera::CameraManager> manager_;
    std::shared_ptr<libcamera::Camera> camera_;
    KernelDevices devices_;
    std::unique_ptr<libcamera::CameraConfiguration> configuration_;
    PixelFormat format_ = PixelFormat::grey;
    std::unique_ptr<libcamera::FrameBufferAllocator> allocator_;
    std::map<const libcamera::FrameBuffer*, std::shared_ptr<const MappedBuffer>> mappings_;
    std::vector<std::unique_ptr<libcamera::Request>> requests_;
    bool started_ = false;
    std::uint64_t damaged_ = 0;
    std::vector<std::string> report_;

    mutable WakeEvent ready_;
    std::mutex mutex_;
    std::deque<libcamera::Request*> completed_;  ///< at most as many as there are requests
    std::atomic<bool> lost_ = false;
    std::atomic<bool> disconnected_ = false;  ///< libcamera knows it too
    bool lends_ = false;
    BufferLender lender_;  ///< the last member, since returned buffers use the members above
};

}  // namespace

std::shared_ptr<libcamera::CameraManager> start_camera_manager() {
    // libcamera logs to standard error by default; its return values report its errors.
    libcamera::logSetTarget(libcamera::LoggingTargetNone);
    auto manager = std::shared_ptr<libcamera::CameraManager>(new libcamera::CameraManager,
                                                             [](libcamera::CameraManager* stopped) {
                                                                 stopped->stop();
                                                                 delete stopped;
                                                             });
    if (const int code = manager->start(); code != 0)
        fail("libcamera does not start (error {}): is this user in the group 'video'?", code);
    return manager;
}

std::unique_ptr<SensorCamera> open_libcamera_camera(
    std::shared_ptr<libcamera::CameraManager> manager, const std::string& pattern,
    const RigConfig::Source& settings, bool side_by_side) {
    return std::make_unique<LibcameraCamera>(std::move(manager), pattern, settings, side_by_side);
}

}  // namespace vantage
