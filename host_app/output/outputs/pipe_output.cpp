#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "common/base/time/pulse_grid.h"
#include "host_app/output/media/picture_encoder.h"
#include "host_app/output/output_target.h"

extern "C" {
#include <libavutil/imgutils.h>
#include <libavutil/pixdesc.h>
}

namespace vantage {
namespace {

constexpr const char* y4m = "y4m";

/// Raw frames without time stamps to a pipe. A dropped frame is replaced by repeating the frame
/// after it, once the reader keeps up again.
class PipeTarget final : public OutputTarget {
  public:
    PipeTarget(int fd, const std::string& form, const OutputFormat& format,
               const OutputPatience& patience)
        : fd_(::fcntl(fd, F_DUPFD_CLOEXEC, 0)),
          pixels_(form == y4m ? AV_PIX_FMT_YUV420P : av_get_pix_fmt(form.c_str())),
          is_y4m_(form == y4m),
          patience_(patience),
          converter_(format.width_px, format.height_px, pixels_) {
        if (fd_.get() < 0) fail("the descriptor cannot be used: {}", std::strerror(errno));
        // A reader that closes the pipe fails this output, and must not end the program.
        std::signal(SIGPIPE, SIG_IGN);
        if (!is_y4m_) return;
        const PulseGrid::Fraction rate = PulseGrid(format.rate_hz).rate();
        const std::string head = fmt::format(
            "YUV4MPEG2 W{} H{} F{}:{} Ip A1:1 C420mpeg2 XYSCSS=420MPEG2 "
            "XCOLORRANGE=LIMITED\n",
            format.width_px, format.height_px, rate.pulses, rate.seconds);
        send({head.begin(), head.end()});
    }

    void write(const ColourImage& picture, std::int64_t tick, const std::string&) override {
        const AVFrame& frame = converter_.convert(picture);
        constexpr std::string_view mark = "FRAME\n";
        const std::size_t head = is_y4m_ ? mark.size() : 0;
        const int size = av_image_get_buffer_size(pixels_, frame.width, frame.height, 1);
        packed_.resize(head + static_cast<std::size_t>(size));
        std::copy_n(mark.data(), head, packed_.begin());
        av_image_copy_to_buffer(reinterpret_cast<std::uint8_t*>(packed_.data() + head), size,
                                frame.data, frame.linesize, pixels_, frame.width, frame.height, 1);
        owed_ = tick - sent_;
        send(packed_);
    }
    bool catch_up() override {
        if (owed_ <= 0) return false;
        --owed_;
        send(packed_);
        return true;
    }
    std::uint64_t bytes() const override { return bytes_; }

  private:
    void send(const std::vector<char>& bytes) {
        for (std::size_t at = 0; at < bytes.size();) {
            if (patience_.is_over()) fail("its reader does not read on");
            // The descriptor may be shared, so that its blocking mode stays unchanged. A small
            // write does not block while poll() reports room.
            constexpr int look_ms = 50;
            constexpr std::size_t never_blocks = PIPE_BUF;
            pollfd room{.fd = fd_.get(), .events = POLLOUT, .revents = 0};
            if (::poll(&room, 1, look_ms) == 0) continue;
            const ssize_t wrote =
                ::write(fd_.get(), bytes.data() + at, std::min(bytes.size() - at, never_blocks));
            if (wrote < 0 && errno != EAGAIN && errno != EINTR)
                fail("its reader is gone: {}", std::strerror(errno));
            if (wrote > 0) at += static_cast<std::size_t>(wrote);
        }
        if (&bytes == &packed_) ++sent_;
        bytes_ += bytes.size();
    }

    UniqueFd fd_;
    AVPixelFormat pixels_;
    bool is_y4m_;
    const OutputPatience& patience_;
    PictureConverter converter_;
    std::vector<char> packed_;  ///< the last frame, in the written format
    std::int64_t sent_ = 0, owed_ = 0;
    std::uint64_t bytes_ = 0;
};

OutputPlan plan(const OutputUrl& url, const OutputFormat& format) {
    url.require_options_of({"format"});
    const std::string form = url.choice("format", {y4m, "yuv420p", "uyvy422", "rgba"});
    int fd = STDOUT_FILENO;
    if (!url.place.empty()) {
        const bool is_number =
            url.place.size() < 5 && std::all_of(url.place.begin(), url.place.end(),
                                                [](unsigned char c) { return std::isdigit(c); });
        if (!is_number)
            fail(
                "the output {}: behind pipe: stands the number of an open descriptor, or nothing "
                "for the standard output",
                url.shown);
        fd = std::stoi(url.place);
    }
    if (::isatty(fd))
        fail("the output {} would write pictures to a terminal: lead it into a pipe or a file",
             url.shown);
    if (form != "rgba" && (format.width_px % 2 != 0 || format.height_px % 2 != 0))
        fail("the output {}: pictures of {}x{} have no {}: their sides have to be even", url.shown,
             format.width_px, format.height_px, form);
    return {.name = url.shown == "-" ? "pipe:" : url.shown,
            .is_encoded = false,
            .takes_stdout = fd == STDOUT_FILENO,
            .open = [fd, form, format](const OutputPatience& patience) {
                return std::make_unique<PipeTarget>(fd, form, format, patience);
            }};
}

}  // namespace

OutputEntry pipe_output_entry() {
    return {"pipe", "- or pipe:FD (pictures without coding, ?format=y4m, yuv420p, uyvy422 or rgba)",
            plan};
}

}  // namespace vantage
