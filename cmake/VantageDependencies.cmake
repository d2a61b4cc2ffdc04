# Every library that Vantage stands on, found once. packages.txt is the list that installs them.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
# Without imgcodecs, which brings GDAL with its databases and formats, seventy libraries and more: two thirds of what a start
# of a program took, and parsers that nobody asked for. common/image reads pictures by libspng and libjpeg-turbo.
find_package(OpenCV 4 REQUIRED COMPONENTS core imgproc calib3d video videoio aruco mcc)
find_package(Ceres REQUIRED)
find_package(Protobuf REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)

pkg_check_modules(EGL REQUIRED IMPORTED_TARGET egl)
pkg_check_modules(GLES REQUIRED IMPORTED_TARGET glesv2)
pkg_check_modules(GBM REQUIRED IMPORTED_TARGET gbm)
pkg_check_modules(ZMQ REQUIRED IMPORTED_TARGET libzmq)
# zmq.h stands by itself. What pkg-config names for the libraries behind it comes out in another order when it is asked
# again, and a third of all objects would be compiled anew at the second start.
set_target_properties(PkgConfig::ZMQ PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "" INTERFACE_COMPILE_OPTIONS "")
pkg_check_modules(SODIUM REQUIRED IMPORTED_TARGET libsodium)
pkg_check_modules(AVAHI REQUIRED IMPORTED_TARGET avahi-client)
# It asks for threads by a definition, which the precompiled headers do not have.
set_target_properties(PkgConfig::AVAHI PROPERTIES INTERFACE_COMPILE_OPTIONS "")
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_search_module(SPNG REQUIRED IMPORTED_TARGET spng libspng)
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
pkg_check_modules(JPEG REQUIRED IMPORTED_TARGET libjpeg)
pkg_check_modules(TOMLPLUSPLUS REQUIRED IMPORTED_TARGET tomlplusplus)
pkg_check_modules(LIBGPIOD REQUIRED IMPORTED_TARGET libgpiodcxx>=2.0)
pkg_check_modules(LIBCAMERA REQUIRED IMPORTED_TARGET libcamera>=0.3)
pkg_check_modules(HIDAPI REQUIRED IMPORTED_TARGET hidapi-hidraw)
pkg_check_modules(LIBLO REQUIRED IMPORTED_TARGET liblo)
pkg_check_modules(ALSA REQUIRED IMPORTED_TARGET alsa)
pkg_check_modules(LTC REQUIRED IMPORTED_TARGET ltc)
if(VANTAGE_WEB OR VANTAGE_METRICS)
  pkg_check_modules(MICROHTTPD REQUIRED IMPORTED_TARGET libmicrohttpd)
endif()
if(VANTAGE_WEB)
  pkg_check_modules(GNUTLS REQUIRED IMPORTED_TARGET gnutls)
endif()
if(VANTAGE_SRT)
  pkg_check_modules(SRT REQUIRED IMPORTED_TARGET srt)
endif()
pkg_check_modules(GLFW REQUIRED IMPORTED_TARGET glfw3)
pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)
pkg_check_modules(OPENEXR REQUIRED IMPORTED_TARGET OpenEXR>=3)
# It asks for threads by an option, which the precompiled headers do not have.
set_target_properties(PkgConfig::OPENEXR PROPERTIES INTERFACE_COMPILE_OPTIONS "")
pkg_check_modules(FFMPEG REQUIRED IMPORTED_TARGET libavformat libavcodec libswscale libswresample libavutil)

find_path(HPDF_INCLUDE_DIR hpdf.h REQUIRED)
find_library(HPDF_LIBRARY hpdf REQUIRED)

# Interfaces under the names the rest of the build uses, so that a dependency reads as what it is for.
add_library(vantage_opencv INTERFACE)
target_link_libraries(vantage_opencv INTERFACE opencv_core opencv_imgproc)
target_include_directories(vantage_opencv SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})

add_library(vantage_hpdf INTERFACE)
target_link_libraries(vantage_hpdf INTERFACE ${HPDF_LIBRARY})
target_include_directories(vantage_hpdf SYSTEM INTERFACE ${HPDF_INCLUDE_DIR})
