#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/config/calibration_file.h"
#include "common/image/image_file.h"
#include "rig_firmware/capture/rig_calibration.h"
#include "tests/hil/devices/rig_process.h"
#include "tests/hil/devices/vivid_loop.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using testing::HasSubstr;

const cv::Size webcam_size(640, 480);

/// A grey picture of the data set, mirrored at its borders to the sensors' size.
cv::Mat sensor_picture(const std::filesystem::path& file) {
    const GreyImage grey = to_grey(read_colour_image(file));
    cv::Mat picture;
    cv::copyMakeBorder(grey, picture, 0, webcam_size.height - grey.rows, 0,
                       webcam_size.width - grey.cols, cv::BORDER_REFLECT);
    return picture;
}

/// Two vivid cameras that see teddy, and the same pictures as files.
class TeddyOnVivid : public testing::Test {
  protected:
    void SetUp() override {
        VANTAGE_REQUIRE_DATA(data);
        left_ = sensor_picture(data / "middlebury2003/teddy/im2.png");
        right_ = sensor_picture(data / "middlebury2003/teddy/im6.png");
        write_grey_image(file("left.png"), left_);
        write_grey_image(file("right.png"), right_);
        save_calibration(file("rig.yaml"), ideal_rig(RigConfig{}, webcam_size), {});
    }

    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

    std::string parts(const std::string& source) const {
        return "calibration = \"" + file("rig.yaml") + "\"\n[source]\n" + source +
               "[match]\npreset = \"fast\"\ndisparities = 16\n";
    }
    std::string files_source() const {
        return "kind = \"files\"\nrate_hz = 2\nleft = \"" + file("left.png") + "\"\nright = \"" +
               file("right.png") + "\"\n";
    }
    static std::string cameras_source() {
        return "kind = \"v4l2\"\nrate_hz = 10\nwidth_px = 640\nheight_px = 480\n"
               "left_device = \"/dev/video10\"\nright_device = \"/dev/video12\"\n"
               "pixel_format = \"GREY\"\n";
    }

    TemporaryFolder folder_;
    cv::Mat left_, right_;
};

TEST_F(TeddyOnVivid, HasTheDisparityThatTheFilesHave) {
    DisparityImage from_files;
    {
        RigProcess rig(parts(files_source()));
        from_files = rig.next_frame()->disparity;
    }
    const VividLoop left("/dev/video10", "/dev/video11", left_);
    const VividLoop right("/dev/video12", "/dev/video13", right_);
    RigProcess rig(parts(cameras_source()));
    const auto frame = rig.next_frame();
    ASSERT_EQ(frame->disparity.size(), from_files.size());
    EXPECT_GT(cv::countNonZero(from_files), static_cast<int>(from_files.total() / 4));
    EXPECT_EQ(cv::norm(frame->disparity, from_files, cv::NORM_L1), 0);
    const nlohmann::json summary = nlohmann::json::parse(rig.stop());
    EXPECT_EQ(summary["source"]["damaged"], 0) << summary;
    EXPECT_THAT(rig.log(), HasSubstr("shared as dma-bufs"));
    EXPECT_THAT(rig.log(), HasSubstr("every picture is copied to the GPU: OpenGL ES is drawn by"));
    EXPECT_GT(summary["source"]["copied_pictures"], 1) << summary;
    EXPECT_EQ(summary["source"]["imported_pictures"], 0) << summary;
}

}  // namespace
}  // namespace vantage
