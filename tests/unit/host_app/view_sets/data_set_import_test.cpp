#include <fstream>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/image/image_file.h"
#include "common/image/pfm.h"
#include "host_app/view_sets/view_set.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// A Microsoft sequence of one small camera, and the same arithmetic done the data set's own way.
class MsrImportTest : public testing::Test {
  protected:
    static constexpr int width_px = 41, height_px = 31;

    MsrImportTest() {
        K_ << 50, 0.5, 19, 0, 51, 16, 0, 0, 1;
        camera_from_world_.linear() =
            Eigen::AngleAxisd(0.2, Eigen::Vector3d(0.1, 1, 0.05).normalized()).toRotationMatrix();
        camera_from_world_.translation() = Eigen::Vector3d(-4, 0.3, 0.7);
        std::ofstream parameters(folder_.path() / "calibParams-ballet.txt");
        parameters.precision(12);
        parameters << "3\n" << K_ << "\n0 0\n" << camera_from_world_.matrix().topRows<3>() << "\n";
        parameters.close();
        fs::create_directory(folder_.path() / "cam3");
        write_colour_image(folder_.path() / "cam3/color-cam3-f007.png",
                           ColourImage(height_px, width_px, cv::Vec4b(9, 99, 199, 255)));
        write_grey_image(folder_.path() / "cam3/depth-cam3-f007.png",
                         cv::Mat1b(height_px, width_px, uchar{code}));
    }

    fs::path out() const { return folder_.path() / "out"; }

    static constexpr int code = 100;
    TemporaryFolder folder_;
    Eigen::Matrix3d K_;
    Pose camera_from_world_ = Pose::Identity();
};

TEST_F(MsrImportTest, PlacesEveryPixelAsTheDataSetDoes) {
    const ImportedViews imported = import_msr3dvideo(folder_.path(), out(), {}, {});
    EXPECT_EQ(imported.views, 1);
    EXPECT_EQ(imported.with_geometry, 1);
    const ViewSet set = load_view_set(out());
    ASSERT_EQ(set.views.size(), 1u);
    const DepthView& view = set.views[0];
    const double world_z = 1 / (code / 255.0 * (1 / 42.0 - 1 / 130.0) + 1 / 130.0);
    for (const auto& [u, row] : {std::pair(0, 0), std::pair(33, 4), std::pair(12, 28)}) {
        // p ~ K [R | t] X with the rows counted from the bottom, solved for the world's x and y.
        const int v = height_px - 1 - row;
        const Eigen::Matrix3d M = K_ * camera_from_world_.linear();
        const Eigen::Vector3d m = K_ * camera_from_world_.translation();
        Eigen::Matrix2d A;
        Eigen::Vector2d b;
        for (int i = 0; i < 2; ++i) {
            const double p = i == 0 ? u : v;
            A.row(i) = M.row(i).head<2>() - p * M.row(2).head<2>();
            b[i] = p * (M(2, 2) * world_z + m[2]) - M(i, 2) * world_z - m[i];
        }
        const Eigen::Vector2d xy = A.inverse() * b;
        const double z = view.depth_m(row, u);
        const Eigen::Vector3d point =
            view.world_from_camera * (z * (view.K.inverse() * Eigen::Vector3d(u, row, 1)));
        EXPECT_NEAR(point.x(), xy[0], 1e-3);
        EXPECT_NEAR(point.y(), -xy[1], 1e-3);
        EXPECT_NEAR(point.z(), world_z, 1e-3);
    }
}

TEST_F(MsrImportTest, ReportsMissingFilesInOneSentence) {
    EXPECT_THROW(import_msr3dvideo(folder_.path(), out(), 8, {}), Error);
    EXPECT_THROW(import_msr3dvideo(folder_.path(), out(), {}, std::pair(5.0, 4.0)), Error);
    EXPECT_FALSE(fs::exists(out() / "views.json"));
    fs::rename(folder_.path() / "calibParams-ballet.txt", folder_.path() / "calibParams-x.txt");
    EXPECT_THROW(import_msr3dvideo(folder_.path(), out(), {}, {}), Error);
    std::ofstream(folder_.path() / "calibParams-x.txt") << "3\n50 0 19 0 51";
    EXPECT_THROW(import_msr3dvideo(folder_.path(), out(), {}, std::pair(1.0, 4.0)), Error);
    EXPECT_THROW(import_msr3dvideo(folder_.path() / "cam3", out(), {}, {}), Error);
}

TEST_F(MsrImportTest, RefusesAnInstantWithoutDepthAndDefaultsToTheFirstWithDepth) {
    fs::copy(folder_.path() / "cam3/color-cam3-f007.png",
             folder_.path() / "cam3/color-cam3-f002.png");
    EXPECT_EQ(import_msr3dvideo(folder_.path(), out(), {}, {}).with_geometry, 1);
    const std::string sentence = thrown_sentence(
        [&] { import_msr3dvideo(folder_.path(), folder_.path() / "other", 2, {}); });
    EXPECT_NE(sentence.find("has no depth map camN/depth-camN-f002.png"), std::string::npos)
        << sentence;
    EXPECT_FALSE(fs::exists(folder_.path() / "other"));
}

TEST_F(MsrImportTest, KeepsAnExistingViewSet) {
    import_msr3dvideo(folder_.path(), out(), {}, {});
    EXPECT_THROW(import_msr3dvideo(folder_.path(), out(), {}, {}), Error);
    EXPECT_EQ(load_view_set(out()).views.size(), 1u);
}

TEST(MiddleburyImport, AgreesWithTheCamerasOfTheViewSetMadeByHand) {
    VANTAGE_REQUIRE_DATA(data);
    const TemporaryFolder folder;
    for (const auto& [scene, by_hand] : {std::pair("middlebury2003/teddy", "teddy"),
                                         std::pair("middlebury2006/aloe_half", "aloe_half")}) {
        const fs::path out = folder.path() / by_hand;
        import_middlebury(data / scene, out);
        const ViewSet set = load_view_set(out),
                      expected = load_view_set(data / "viewsets" / by_hand);
        ASSERT_EQ(set.views.size(), expected.views.size());
        for (const DepthView& view : set.views) {
            const DepthView& other = expected.views[expected.index_of(view.name)];
            EXPECT_EQ(view.K(0, 0), other.K(0, 0));
            EXPECT_EQ(view.doffs_px, other.doffs_px) << view.name;
            EXPECT_DOUBLE_EQ(view.baseline_m, other.baseline_m);
            EXPECT_EQ(cv::norm(view.colour, other.colour, cv::NORM_INF), 0);
            ASSERT_EQ(view.depth_m.size(), other.depth_m.size());
            if (!view.depth_m.empty()) {
                EXPECT_LT(cv::norm(view.depth_m, other.depth_m, cv::NORM_INF), 1e-4);
            }
        }
        // All that shows between the views is how far they stand and their centres lie apart.
        const auto step = [](const ViewSet& views) {
            const DepthView &a = views.views[1], &b = views.views[2];
            return Eigen::Vector2d(
                b.K(0, 2) - a.K(0, 2),
                b.world_from_camera.translation().x() - a.world_from_camera.translation().x());
        };
        EXPECT_LT((step(set) - step(expected)).norm(), 1e-9);
    }
}

TEST(MiddleburyImport, RefusesAMapThatCannotBeReadBeforeItWritesAnything) {
    const TemporaryFolder folder;
    for (const char* name : {"im0.png", "im1.png"})
        write_colour_image(folder.path() / name, ColourImage(6, 8, cv::Vec4b(1, 2, 3, 255)));
    std::ofstream(folder.path() / "calib.txt")
        << "cam0=[100 0 3.5; 0 101 2.5; 0 0 1]\ncam1=[100 0 5.5; 0 101 2.5; 0 0 1]\n"
           "doffs=2\nbaseline=60\n";
    const auto refusal = [&](const char* out) {
        return thrown_sentence([&] { import_middlebury(folder.path(), folder.path() / out); });
    };
    std::ofstream(folder.path() / "disp0.pfm") << "Pf\n8 6\n-1\nshort";
    EXPECT_NE(refusal("a").find("disp0.pfm should hold"), std::string::npos) << refusal("a2");
    EXPECT_FALSE(fs::exists(folder.path() / "a/views.json"));
    write_pfm(folder.path() / "disp0.pfm", cv::Mat1f(6, 12, 4.0f));
    EXPECT_NE(refusal("b").find("12x6"), std::string::npos);
    write_pfm(folder.path() / "disp0.pfm", cv::Mat1f(6, 8, 4.0f));
    EXPECT_EQ(refusal("c"), "");
}

TEST(MiddleburyImport, ReadsACalibratedPair) {
    const TemporaryFolder folder;
    for (const char* name : {"im0.png", "im1.png"})
        write_colour_image(folder.path() / name, ColourImage(6, 8, cv::Vec4b(1, 2, 3, 255)));
    write_pfm(folder.path() / "disp0.pfm", cv::Mat1f(6, 8, 4.0f));
    std::ofstream(folder.path() / "calib.txt")
        << "cam0=[100 0 3.5; 0 101 2.5; 0 0 1]\ncam1=[100 0 5.5; 0 101 2.5; 0 0 1]\n"
           "doffs=2\nbaseline=60\n";
    EXPECT_EQ(import_middlebury(folder.path(), folder.path() / "out").with_geometry, 1);
    const ViewSet set = load_view_set(folder.path() / "out");
    EXPECT_FLOAT_EQ(set.views[0].depth_m(3, 3), 100 * 0.06f / 6);
    EXPECT_EQ(set.views[1].K(0, 2), 5.5);
    std::ofstream(folder.path() / "calib.txt") << "cam0=[100 0]\ncam1=\ndoffs=2\nbaseline=60\n";
    EXPECT_THROW(import_middlebury(folder.path(), folder.path() / "other"), Error);
    EXPECT_THROW(import_middlebury(folder.path() / "nowhere", folder.path() / "other"), Error);
}

}  // namespace
}  // namespace vantage
