// SPDX-License-Identifier: GPL-3.0-or-later
#include <crosscheck/povray.h>
#include <reference/content_key.h>
#include <vmap/compare/picture_file.h>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

namespace vmap::crosscheck {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// A folder of our own for one run, gone afterwards.
class WorkFolder {
public:
    explicit WorkFolder(const fs::path& parent) {
        fs::create_directories(parent);
        std::string name = (parent / "run-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": cannot be made");
        path_ = name;
    }
    ~WorkFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    [[nodiscard]] const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

void run(const fs::path& folder, const std::string& options) {
    const std::string command =
        fmt::format("cd '{}' && povray {} >povray.log 2>&1 </dev/null", folder.string(), options);
    if (std::system(command.c_str()) != 0)
        throw std::runtime_error("povray failed:\n" + content_of(folder / "povray.log"));
}

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Of processor time: with one thread as good as the clock's, whatever else the machine does.
double seconds_of_children() {
    rusage usage{};
    ::getrusage(RUSAGE_CHILDREN, &usage);
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

std::string povray_version() {
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen("povray --version 2>&1", "r"), &::pclose);
    if (!pipe) return {};
    std::array<char, 256> line{};
    while (std::fgets(line.data(), line.size(), pipe.get()) != nullptr) {
        const std::string text(line.data());
        constexpr std::string_view start = "POV-Ray ";
        if (text.starts_with(start))
            return text.substr(start.size(), text.find_first_of(" \n", start.size()) - start.size());
    }
    return {};
}

PovPicture render_by_povray(const Scene& scene, const PovConfig& config, const fs::path& cache) {
    const WorkFolder folder(cache);
    const PovExport files = write_pov_scene(scene, (folder.path() / "scene.pov").string(), {}, config);
    PovPicture result;
    result.options = fmt::format("+Iscene.pov +Oscene.exr +FE +W{} +H{} -A +WT1 -D", config.width, config.height);
    reference::ContentKey key;
    key.add(povray_version());
    key.add(result.options);
    for (const std::string& file : files.files) key.add(content_of(file));

    const fs::path picture = cache / (key.text() + ".exr");
    const fs::path seconds = cache / (key.text() + ".seconds");
    result.kept = fs::exists(picture) && fs::exists(seconds);
    if (!result.kept) {
        const double start = seconds_of_children();
        run(folder.path(), result.options);
        std::ofstream(folder.path() / "seconds") << seconds_of_children() - start;
        fs::rename(folder.path() / "scene.exr", picture);
        fs::rename(folder.path() / "seconds", seconds);
    }
    std::ifstream(seconds) >> result.seconds;
    result.picture = read_picture(picture);
    return result;
}

}  // namespace vmap::crosscheck
