#include "rig_firmware/capture/camera_intake.h"

#include "common/base/error.h"
#include "common/base/log.h"
#include "rig_firmware/capture/dma_buf_access.h"

namespace vantage {
namespace {

/// The number that shaders/capture/camera_formats.glsl has for the format.
int shader_format(PixelFormat format) {
    switch (format) {
        case PixelFormat::y10:
            return 1;
        case PixelFormat::y16:
            return 2;
        case PixelFormat::yuyv:
            return 3;
        case PixelFormat::nv12:
            return 4;
        case PixelFormat::grey:
        case PixelFormat::mjpg:
            break;
    }
    return 0;
}

/// Grey formats and YUYV have one plane, and no use for chroma.
template <class Planes>
void set_inputs(Program& program, const Planes& planes) {
    program.input("raw", planes.front());
    program.input("chroma", planes.back());
}

/// A view of the plane's bytes; OpenCV wants them writable and nothing writes.
cv::Mat texels_of(const RawPicture& picture, const PicturePlane& plane) {
    const std::byte* begin = picture.bytes.data() + plane.offset;
    return {plane.height_px, plane.width_px, format_info(plane.format).cv_type,
            const_cast<std::byte*>(begin), plane.bytes_per_line};
}

}  // namespace

CameraIntake::CameraIntake(const EglContext& context, const ShaderLibrary& library, cv::Size size)
    : context_(context),
      library_(library),
      colour_(TextureFormat::rgba8, size.width, size.height, Filter::linear),
      target_({&colour_}) {}

void CameraIntake::prepare(const LentPicture& specimen, const std::string& why_not,
                           const std::function<void(const RawPlanes&)>& warm_up) {
    imports_ = false;
    if (!why_not.empty()) {
        reason_ = why_not;
    } else if (specimen.dma_buf < 0) {
        reason_ = "the camera's driver does not share its buffers";
    } else {
        try {
            imported(specimen);
            imports_ = true;
            reason_.clear();
        } catch (const Error& error) {
            reason_ = error.what();
        }
    }
    // Drivers finish their programs at the first drawing.
    if (warm_up)
        warm_up(planes(specimen));
    else
        (void)bring(specimen);
    counts_ = {};
}

const Texture& CameraIntake::bring(const ColourImage& picture) {
    colour_.upload(picture);
    return colour_;
}

const Texture& CameraIntake::bring(const LentPicture& picture) {
    const RawPlanes raw = planes(picture);
    FullscreenPass& pass = pass_for(picture.raw.format);
    Program& program = pass.use();
    raw.inputs(program);
    program.set("first_column_px", raw.first_column_px);
    pass.overwrite(target_);
    return colour_;
}

RawPlanes CameraIntake::planes(const LentPicture& picture) {
    if (picture.view.size() != colour_.size())
        fail("a camera delivers a picture of {}x{}, and {}x{} was agreed on", picture.view.width,
             picture.view.height, colour_.width_px(), colour_.height_px());
    const std::vector<DmaBufTexture>* imports = nullptr;
    if (imports_ && picture.dma_buf >= 0) {
        try {
            imports = &imported(picture);
        } catch (const Error& error) {
            // One that was plugged in anew may have another driver.
            log_warning("{}; pictures are copied from now on", error.what());
            imports_ = false;
            reason_ = error.what();
        }
    }
    if (imports) {
        ++counts_.imported;
    } else {
        copy(picture);
        ++counts_.copied;
    }
    const auto inputs = [this, imports](Program& program) {
        if (imports)
            set_inputs(program, *imports);
        else
            set_inputs(program, copies_);
    };
    std::vector<cv::Size> plane_sizes;
    for (const PicturePlane& plane : planes_of(picture.raw))
        plane_sizes.emplace_back(plane.width_px, plane.height_px);
    return {.shader_format = shader_format(picture.raw.format),
            .size = colour_.size(),
            .first_column_px = picture.view.x,
            .plane_sizes = std::move(plane_sizes),
            .inputs = inputs};
}

const std::vector<DmaBufTexture>& CameraIntake::imported(const LentPicture& picture) {
    if (picture.camera != camera_) {
        imports_of_.clear();
        camera_ = picture.camera;
    }
    const auto found = imports_of_.find(picture.index);
    if (found != imports_of_.end()) return found->second;
    std::vector<DmaBufTexture> planes;
    for (const PicturePlane& plane : planes_of(picture.raw))
        planes.emplace_back(
            context_,
            DmaBufPlane{.fd = picture.dma_buf,
                        .format = plane.format,
                        .width_px = plane.width_px,
                        .height_px = plane.height_px,
                        .offset = static_cast<std::uint32_t>(picture.offset + plane.offset),
                        .bytes_per_line = static_cast<std::uint32_t>(plane.bytes_per_line)});
    return imports_of_.emplace(picture.index, std::move(planes)).first->second;
}

void CameraIntake::copy(const LentPicture& picture) {
    const std::vector<PicturePlane> planes = planes_of(picture.raw);
    const auto fits = [&](std::size_t i) {
        return copies_[i].format() == planes[i].format &&
               copies_[i].size() == cv::Size(planes[i].width_px, planes[i].height_px);
    };
    bool all_fit = copies_.size() == planes.size();
    for (std::size_t i = 0; all_fit && i < planes.size(); ++i) all_fit = fits(i);
    if (!all_fit) {
        copies_.clear();
        for (const PicturePlane& plane : planes)
            copies_.emplace_back(plane.format, plane.width_px, plane.height_px);
    }
    const DmaBufAccess access(picture.dma_buf);
    for (std::size_t i = 0; i < planes.size(); ++i)
        copies_[i].upload(texels_of(picture.raw, planes[i]));
}

FullscreenPass& CameraIntake::pass_for(PixelFormat format) {
    if (!pass_ || format_ != format) {
        pass_.emplace(library_, "camera_picture.frag",
                      ShaderDefines{{"FORMAT", std::to_string(shader_format(format))}});
        format_ = format;
    }
    return *pass_;
}

}  // namespace vantage
