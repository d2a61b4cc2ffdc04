#include "rig_firmware/stereo/thesis/picture_words_pass.h"

namespace vantage::thesis {

PictureWordsPass::PictureWordsPass(const ShaderLibrary& library, cv::Size size)
    : pass_(library, "thesis_picture_words.comp", size) {}

void PictureWordsPass::run(const Texture& picture, const Buffer& words) {
    Program& program = pass_.use();
    program.set("picture", 0);
    picture.bind(0);
    words.bind_storage(0);
    pass_.dispatch();
}

}  // namespace vantage::thesis
