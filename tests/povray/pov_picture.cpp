// SPDX-License-Identifier: GPL-3.0-or-later
#include "pov_picture.h"

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace vmap {
namespace {

namespace fs = std::filesystem;
using Imath::M44d;
using Imath::V3d;

Picture read_exr(const std::string& path) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    Picture picture;
    picture.width = window.max.x + 1;
    picture.height = window.max.y + 1;
    picture.pixels.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    Imf::FrameBuffer buffer;
    const char* names[] = {"R", "G", "B"};
    for (int channel = 0; channel < 3; ++channel)
        buffer.insert(names[channel],
                      Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&picture.pixels[0].x + channel),
                                 sizeof(Imath::C3f), sizeof(Imath::C3f) * static_cast<std::size_t>(picture.width)));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return picture;
}

bool has_povray() {
    return std::system("command -v povray >/dev/null 2>&1") == 0;
}

}  // namespace

Ray ray_through(const Camera& camera, int x, int y, int width, int height) {
    const double right = (x + 0.5) / width * 2 - 1;
    const double up = 1 - (y + 0.5) / height * 2;
    const double aspect = static_cast<double>(width) / height;
    const double slope = std::tan(camera.vertical_fov / 2);
    const V3d local(right * slope * aspect, up * slope, -1);
    Ray ray;
    ray.origin = V3d(0) * camera.world_from_camera;
    camera.world_from_camera.multDirMatrix(local.normalized(), ray.direction);
    return ray;
}

Camera camera_over_square() {
    Camera camera;
    camera.world_from_camera = moved({0, 0, 5});
    camera.orthographic = true;
    camera.half_height = 1;
    return camera;
}

std::size_t add_square(Scene& scene, std::size_t material) {
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.texcoords = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.material = material;
    scene.meshes.push_back(mesh);
    return scene.meshes.size() - 1;
}

void add_instance(Scene& scene, std::size_t mesh, const M44d& world_from_mesh) {
    Instance instance;
    instance.mesh = mesh;
    instance.world_from_mesh = world_from_mesh;
    scene.instances.push_back(instance);
}

M44d scaled(const V3d& scale) {
    M44d m;
    m.setScale(scale);
    return m;
}

M44d moved(const V3d& translation) {
    M44d m;
    m.setTranslation(translation);
    return m;
}

LightSource sun_from_above() {
    LightSource sun;
    sun.kind = LightKind::sun;
    sun.direction = {0, 0, -1};
    sun.intensity = Imath::C3f(std::numbers::pi_v<float>);
    return sun;
}

Scene square_under_sun() {
    Scene scene;
    scene.materials.resize(1);
    add_instance(scene, add_square(scene, 0));
    scene.lights = {sun_from_above()};
    scene.cameras = {camera_over_square()};
    return scene;
}

PovRayTest::PovRayTest() : folder(fs::path(testing::TempDir()) / ("vmap_povray_" + std::to_string(::getpid()))) {
    fs::create_directories(folder);
}

PovRayTest::~PovRayTest() {
    fs::remove_all(folder);
}

void PovRayTest::SetUp() {
    if (!has_povray()) GTEST_SKIP() << "povray is missing: nothing is known about our POV-Ray scenes";
}

std::string PovRayTest::content(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t PovRayTest::file_count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

Picture PovRayTest::render(const Scene& scene, PovConfig config, const OutputInfo& info) const {
    if (!config.bounces) config.bounces = 0;
    write_pov_scene(scene, path("scene.pov"), info, config);
    return render_file("scene.pov", config.width, config.height);
}

Picture PovRayTest::render_file(const std::string& name, int width, int height) const {
    const std::string command = "cd '" + folder.string() + "' && timeout -s KILL 60 povray +I'" + name +
                                "' +Opicture.exr +FE +W" + std::to_string(width) + " +H" + std::to_string(height) +
                                " -A +WT1 -D >povray.log 2>&1 </dev/null";
    if (std::system(command.c_str()) != 0) throw std::runtime_error("povray failed:\n" + content("povray.log"));
    return read_exr(path("picture.exr"));
}

}  // namespace vmap
