// SPDX-License-Identifier: GPL-3.0-or-later
#include "images.h"

#include "../content_error.h"
#include "../decode_image.h"
#include "../uri.h"
#include "../warnings.h"
#include "limits.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <string>
#include <utility>

namespace vmap::gltf {
namespace {

/// An image on its way from its file to its pixels.
struct Job {
    Bytes owned;                      // empty when the bytes lie in a buffer
    std::span<const std::byte> file;  // empty: nothing to decode
    ImageHeader header;
    std::optional<Image> image;
    std::string failure;
};

void find_bytes(const ImageInfo& info, Buffers& buffers, const SceneFolder& folder, Job& job) {
    if (!info.uri) {
        job.file = buffers.view(info.view);
        return;
    }
    if (std::optional<Bytes> embedded = bytes_from_data_uri(*info.uri))
        job.owned = std::move(*embedded);
    else
        job.owned = read_file(folder.find(path_from_uri(*info.uri)), largest_image_file);
    job.file = job.owned.span();
}

/// Calls a function and keeps what it complains about.
template <class Function>
void attempt(Job& job, const Function& function) {
    try {
        function();
    } catch (const BrokenContent& error) {
        job.failure = error.what();
    } catch (const UnsupportedContent& error) {
        job.failure = error.what();
    }
}

}  // namespace

std::vector<std::optional<Image>> load_images(const Document& document, const std::vector<bool>& used, Buffers& buffers,
                                              const SceneFolder& folder, Warnings& warnings) {
    std::vector<Job> jobs(document.images.size());
    std::uint64_t pixels = 0;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        Job& job = jobs[i];
        if (!used[i]) continue;
        attempt(job, [&] {
            find_bytes(document.images[i], buffers, folder, job);
            job.header = read_image_header(job.file);
            if (job.header.pixels() > most_pixels - pixels)
                throw UnsupportedContent(fmt::format("the images have more than {} pixels in all", most_pixels));
            pixels += job.header.pixels();
        });
    }
    tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t i) {
        Job& job = jobs[i];
        if (job.file.empty() || !job.failure.empty()) return;
        attempt(job, [&] { job.image = decode_image(job.file, job.header); });
        job.owned = Bytes();
    });

    std::vector<std::optional<Image>> images(jobs.size());
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (std::optional<Image>& image = jobs[i].image) {
            image->name = document.images[i].name;
            images[i] = std::move(image);
        } else if (used[i]) {
            warnings.add("images that cannot be read are left out", document.images[i].name + ": " + jobs[i].failure);
        }
    }
    return images;
}

}  // namespace vmap::gltf
