#include "host_app/output/media/mp4_fragments.h"

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "tests/support/data_folder.h"

namespace vantage {
namespace {

/// A box of so many bytes in all.
std::string box(const std::string& type, std::size_t bytes) {
    return std::string{'\0', '\0', '\0', static_cast<char>(bytes)} + type +
           std::string(bytes - 8, 'x');
}

class Mp4FragmentsTest : public testing::Test {
  protected:
    std::string cut(const std::string& content) {
        const std::filesystem::path path = folder_.path() / "film.mp4";
        std::ofstream(path, std::ios::binary) << content;
        cut_to_whole_fragments(path);
        std::ifstream in(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    TemporaryFolder folder_;
    const std::string head_ = box("ftyp", 20) + box("moov", 40),
                      fragment_ = box("moof", 16) + box("mdat", 30);
};

TEST_F(Mp4FragmentsTest, KeepsWhatIsWhole) {
    EXPECT_EQ(cut(head_ + fragment_ + fragment_), head_ + fragment_ + fragment_);
    // 64 bits of size where 32 do not do.
    const std::string large = box("moof", 16) + std::string{'\0', '\0', '\0', '\1'} + "mdat" +
                              std::string(7, '\0') + std::string{'\x18'} + "12345678";
    EXPECT_EQ(cut(head_ + large + fragment_), head_ + large + fragment_);
    EXPECT_EQ(cut(head_ + large + "more"), head_ + large);
}

TEST_F(Mp4FragmentsTest, CutsOffHalfAFragmentWhereverItEnds) {
    const std::string whole = head_ + fragment_;
    for (std::size_t bytes = 1; bytes < fragment_.size(); ++bytes)
        EXPECT_EQ(cut(whole + fragment_.substr(0, bytes)), whole) << bytes;
}

TEST_F(Mp4FragmentsTest, LeavesNothingOfWhatIsNoSuchFile) {
    EXPECT_EQ(cut("something else altogether"), "");
    EXPECT_EQ(cut(std::string(40, '\0')), "");
    EXPECT_EQ(cut(""), "");
}

}  // namespace
}  // namespace vantage
