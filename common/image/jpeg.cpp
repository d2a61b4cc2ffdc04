#include "common/image/jpeg.h"

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>

#include <jpeglib.h>
#include <turbojpeg.h>

// Its names stand in no namespace and need jpeglib.h before it.
#include <jerror.h>

#include "common/base/error.h"
#include "common/image/exif_orientation.h"
#include "common/image/picture_size.h"

namespace vantage {
namespace {

constexpr int quality = 95;
/// A progressive picture of endless scans would hold the decoder up; real ones have about ten.
constexpr int max_scans = 500;

struct HandleDeleter {
    void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, HandleDeleter>;

/// The messages that libjpeg's callbacks collect. Its first member is libjpeg's own error manager.
struct JpegMessages {
    jpeg_error_mgr manager{};
    std::jmp_buf on_error{};
    char error[JMSG_LENGTH_MAX] = "";
    char first_warning[JMSG_LENGTH_MAX] = "";
    bool lost_pixels = false, ended_early = false;
};

JpegMessages& messages_of(j_common_ptr jpeg) { return *reinterpret_cast<JpegMessages*>(jpeg->err); }

[[noreturn]] void note_error(j_common_ptr jpeg) {
    JpegMessages& messages = messages_of(jpeg);
    jpeg->err->format_message(jpeg, messages.error);
    std::longjmp(messages.on_error, 1);
}

void note_warning(j_common_ptr jpeg, int level) {
    if (level >= 0) return;
    JpegMessages& messages = messages_of(jpeg);
    ++jpeg->err->num_warnings;
    switch (jpeg->err->msg_code) {
        case JWRN_JPEG_EOF:
            messages.ended_early = true;
            break;
        // An unknown revision or colour transform, and bytes before a marker, cost no pixel.
        case JWRN_JFIF_MAJOR:
        case JWRN_ADOBE_XFORM:
        case JWRN_EXTRANEOUS_DATA:
            break;
        default:
            if (!messages.lost_pixels) jpeg->err->format_message(jpeg, messages.error);
            messages.lost_pixels = true;
    }
    if (messages.first_warning[0] == '\0') jpeg->err->format_message(jpeg, messages.first_warning);
}

void write_nothing(j_common_ptr) {}

void limit_scans(j_common_ptr jpeg) {
    if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <= max_scans) return;
    JpegMessages& messages = messages_of(jpeg);
    std::snprintf(messages.error, sizeof messages.error, "it has more than %d scans", max_scans);
    std::longjmp(messages.on_error, 1);
}

/// One picture of libjpeg. The library leaves a function that fails by longjmp, so the functions
/// that call it hold nothing that would have to be destroyed.
class JpegPicture {
  public:
    explicit JpegPicture(std::span<const std::byte> bytes) {
        jpeg_.err = jpeg_std_error(&messages_.manager);
        messages_.manager.error_exit = note_error;
        messages_.manager.emit_message = note_warning;
        messages_.manager.output_message = write_nothing;
        if (begin(bytes)) return;
        jpeg_destroy_decompress(&jpeg_);
        fail("it is a damaged JPEG ({})", messages_.error);
    }
    ~JpegPicture() { jpeg_destroy_decompress(&jpeg_); }
    JpegPicture(const JpegPicture&) = delete;
    JpegPicture& operator=(const JpegPicture&) = delete;

    const jpeg_decompress_struct& header() const { return jpeg_; }

    void read_into(cv::Mat& image, J_COLOR_SPACE colours) {
        if (!read_rows(image.data, image.step, colours) || messages_.lost_pixels)
            fail("it is a damaged or cut off JPEG ({})", messages_.error);
        if (messages_.ended_early && !is_complete_)
            fail("it is a damaged or cut off JPEG ({})", messages_.first_warning);
    }
    const char* first_warning() const { return messages_.first_warning; }

    int orientation() const {
        constexpr std::string_view exif("Exif\0\0", 6);
        for (jpeg_saved_marker_ptr marker = jpeg_.marker_list; marker; marker = marker->next) {
            const std::string_view text(reinterpret_cast<const char*>(marker->data),
                                        marker->data_length);
            if (text.starts_with(exif))
                return exif_orientation(std::as_bytes(std::span(text)).subspan(exif.size()));
        }
        return 1;
    }

  private:
    bool begin(std::span<const std::byte> bytes) {
        if (setjmp(messages_.on_error)) return false;
        jpeg_create_decompress(&jpeg_);
        jpeg_.progress = &progress_;
        progress_.progress_monitor = limit_scans;
        constexpr unsigned most_exif_bytes = 0xffff;
        jpeg_save_markers(&jpeg_, JPEG_APP0 + 1, most_exif_bytes);
        jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(bytes.data()),
                     static_cast<unsigned long>(bytes.size()));
        jpeg_read_header(&jpeg_, TRUE);
        return true;
    }
    bool read_rows(unsigned char* pixels, std::size_t step, J_COLOR_SPACE colours) {
        if (setjmp(messages_.on_error)) return false;
        jpeg_.out_color_space = colours;
        // As turbojpeg decodes the stream, so that a file and a frame of the same bytes agree.
        jpeg_.dct_method = JDCT_ISLOW;
        jpeg_start_decompress(&jpeg_);
        while (jpeg_.output_scanline < jpeg_.output_height) {
            JSAMPROW row = pixels + step * jpeg_.output_scanline;
            jpeg_read_scanlines(&jpeg_, &row, 1);
        }
        is_complete_ = every_coefficient_came();
        jpeg_finish_decompress(&jpeg_);
        return true;
    }
    /// A sequential picture is complete once its rows are: the library warns of missing ones. Of a
    /// progressive one whole scans may be missing, which it does not mention.
    bool every_coefficient_came() const {
        if (!jpeg_.progressive_mode || !jpeg_.coef_bits) return true;
        for (int component = 0; component < jpeg_.num_components; ++component)
            for (int i = 0; i < DCTSIZE2; ++i)
                if (jpeg_.coef_bits[component][i] != 0) return false;
        return true;
    }

    JpegMessages messages_;
    jpeg_decompress_struct jpeg_{};
    jpeg_progress_mgr progress_{};
    bool is_complete_ = false;
};

}  // namespace

DecodedJpeg decode_jpeg(std::span<const std::byte> bytes, JpegChannels channels) {
    JpegPicture picture(bytes);
    const jpeg_decompress_struct& header = picture.header();
    require_picture_size(header.image_width, header.image_height);
    if (header.jpeg_color_space == JCS_CMYK || header.jpeg_color_space == JCS_YCCK)
        fail("it is a JPEG for printing, in CMYK; convert it to RGB");
    const bool is_grey = header.jpeg_color_space == JCS_GRAYSCALE;
    const bool has_alpha = channels == JpegChannels::rgba;
    DecodedJpeg decoded;
    // The library frees the markers once the picture is read.
    decoded.orientation = picture.orientation();
    decoded.image.create(static_cast<int>(header.image_height),
                         static_cast<int>(header.image_width),
                         has_alpha ? CV_8UC4
                         : is_grey ? CV_8UC1
                                   : CV_8UC3);
    picture.read_into(decoded.image, has_alpha ? JCS_EXT_RGBA : is_grey ? JCS_GRAYSCALE : JCS_RGB);
    decoded.oddity = picture.first_warning();
    return decoded;
}

std::vector<std::byte> encode_jpeg(const cv::Mat& image) {
    const bool is_grey = image.type() == CV_8UC1;
    if (!is_grey && image.type() != CV_8UC3) fail("a JPEG does not take this picture");
    const Handle handle(tjInitCompress());
    if (!handle) fail("there is no memory for a JPEG");
    const int sampling = is_grey ? TJSAMP_GRAY : TJSAMP_420;
    std::vector<std::byte> bytes(tjBufSize(image.cols, image.rows, sampling));
    auto* data = reinterpret_cast<unsigned char*>(bytes.data());
    unsigned long size = bytes.size();
    if (tjCompress2(handle.get(), image.data, image.cols, static_cast<int>(image.step), image.rows,
                    is_grey ? TJPF_GRAY : TJPF_RGB, &data, &size, sampling, quality,
                    TJFLAG_NOREALLOC) != 0)
        fail("a JPEG cannot be made of this picture ({})", tjGetErrorStr2(handle.get()));
    bytes.resize(size);
    return bytes;
}

}  // namespace vantage
