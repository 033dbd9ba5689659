// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// vmap query: the seed's four questions to a saved visibility map.
#include "commands.h"
#include "query_text.h"

#include <vmap/error.h>
#include <vmap/printable.h>
#include <vmap/query_vmap.h>
#include <vmap/show_visibility.h>
#include <vmap/vmap_file.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace vmap {
namespace {

using Json = nlohmann::ordered_json;

struct QueryOptions {
    std::string map;
    std::vector<std::string> sees;
    std::vector<std::string> groups;
    std::vector<std::string> ray;
    std::vector<std::string> umbra;
    std::string file;
    std::string rays;
    bool json = false;
};

const char* name_of(PairStatus status) {
    switch (status) {
        case PairStatus::visible:
            return "visible";
        case PairStatus::invisible:
            return "invisible";
        case PairStatus::partial:
            break;
    }
    return "partial";
}

/// What a point gets of a light.
const char* shadow_name(PairStatus status) {
    switch (status) {
        case PairStatus::visible:
            return "lit";
        case PairStatus::invisible:
            return "umbra";
        case PairStatus::partial:
            break;
    }
    return "penumbra";
}

/// Answers to the questions of one map.
class Answerer {
public:
    explicit Answerer(const VmapContents& contents)
        : contents_(contents),
          query_(contents.cloud, contents.tree, contents.map, contents.patches),
          lights_(scene_lights(contents.cloud, contents.lights)) {}

    [[nodiscard]] Json answer(const Question& question) const {
        switch (question.kind) {
            case QuestionKind::sees:
                return answer_sees(question);
            case QuestionKind::groups:
                return answer_groups(question);
            case QuestionKind::ray:
                return answer_ray(question);
            case QuestionKind::umbra:
                break;
        }
        return answer_umbra(question);
    }

private:
    [[nodiscard]] std::uint32_t point_of(const PointSpec& spec, const Question& question) const {
        if (const auto* place = std::get_if<Imath::V3d>(&spec.where)) return query_.nearest_point(*place);
        const std::uint32_t index = std::get<std::uint32_t>(spec.where);
        if (index >= contents_.cloud.size())
            throw UsageError(
                fmt::format("{}: point {}; the map has {} points", question.text, index, contents_.cloud.size()));
        return index;
    }

    [[nodiscard]] std::vector<std::uint32_t> group_of(const PointSpec& spec, const Question& question) const {
        const std::uint32_t point = point_of(spec, question);
        if (!spec.radius) return {point};
        const auto* place = std::get_if<Imath::V3d>(&spec.where);
        std::vector<std::uint32_t> group = query_.points_around(
            place != nullptr ? *place : contents_.cloud.origin + Imath::V3d(contents_.cloud.positions[point]),
            *spec.radius);
        if (group.empty()) throw UsageError(question.text + ": no points within the radius");
        return group;
    }

    [[nodiscard]] Json answer_sees(const Question& question) const {
        const std::uint32_t x = point_of(question.points[0], question);
        const std::uint32_t y = point_of(question.points[1], question);
        return {{"answer", query_.sees(x, y) ? "visible" : "invisible"}, {"points", {x, y}}};
    }

    [[nodiscard]] Json answer_groups(const Question& question) const {
        const std::vector<std::uint32_t> xs = group_of(question.points[0], question);
        const std::vector<std::uint32_t> ys = group_of(question.points[1], question);
        QueryCost cost;
        const PairStatus status = query_.status(xs, ys, &cost);
        return {{"answer", name_of(status)},
                {"points", {xs.size(), ys.size()}},
                {"pairs", std::uint64_t{xs.size()} * ys.size()},
                {"primitive_tests", cost.primitive_tests}};
    }

    [[nodiscard]] Json answer_ray(const Question& question) const {
        const auto hit = query_.first_point(question.from, question.direction);
        if (!hit) return {{"answer", "miss"}};
        return {{"answer", "hit"}, {"point", hit->point}, {"distance", hit->distance}};
    }

    [[nodiscard]] Json answer_umbra(const Question& question) const {
        const std::uint32_t x = point_of(question.points[0], question);
        Json lights = Json::array();
        for (std::size_t light = 0; light < lights_.size(); ++light)
            lights.push_back(
                {{"light", light_name(light)}, {"answer", shadow_name(light_status(query_, x, lights_, light))}});
        return {{"point", x}, {"lights", lights}};
    }

    [[nodiscard]] std::string light_name(std::size_t light) const {
        if (light >= lights_.sources.size()) return fmt::format("surface{}", light - lights_.sources.size());
        const std::string& name = lights_.sources[light].name;
        return name.empty() ? fmt::format("light{}", light) : printable(name);
    }

    const VmapContents& contents_;
    VmapQuery query_;
    SceneLights lights_;
};

/// The answer on one line.
std::string as_line(const Json& answer) {
    if (answer.contains("distance"))
        return fmt::format("{} {:.9g}", answer["point"].get<std::uint32_t>(), answer["distance"].get<double>());
    if (answer.contains("primitive_tests"))
        return fmt::format("{} pairs={} primitive_tests={}", answer["answer"].get<std::string>(),
                           answer["pairs"].get<std::uint64_t>(), answer["primitive_tests"].get<std::uint64_t>());
    if (!answer.contains("lights")) return answer["answer"].get<std::string>();
    std::string line;
    for (const Json& light : answer["lights"])
        line += fmt::format("{}{}={}", line.empty() ? "" : " ", light["light"].get<std::string>(),
                            light["answer"].get<std::string>());
    return line.empty() ? "no lights" : line;
}

std::vector<Question> questions_of(const QueryOptions& options) {
    std::vector<Question> questions;
    const auto add = [&](const std::string& kind, const std::vector<std::string>& values, std::size_t each) {
        for (std::size_t i = 0; i + each <= values.size(); i += each) {
            std::vector<std::string> words{kind};
            words.insert(words.end(), values.begin() + static_cast<std::ptrdiff_t>(i),
                         values.begin() + static_cast<std::ptrdiff_t>(i + each));
            questions.push_back(parse_question("--" + kind, words));
        }
    };
    add("sees", options.sees, 2);
    add("groups", options.groups, 2);
    add("ray", options.ray, 2);
    add("umbra", options.umbra, 1);
    const auto add_file = [&](const std::string& file, const std::string& kind) {
        if (file.empty()) return;
        for (Question& question : read_questions(file, kind)) questions.push_back(std::move(question));
    };
    add_file(options.file, "");
    add_file(options.rays, "ray");
    return questions;
}

void run_query(const QueryOptions& options, Job& job) {
    const std::vector<Question> questions = questions_of(options);
    if (questions.empty()) throw UsageError("no question; expected --sees, --groups, --ray, --umbra, --file or --rays");
    const VmapContents contents = read_vmap(options.map);
    if (contents.cloud.empty()) throw UnsupportedInput(printable(options.map) + ": has no points");
    const Answerer answerer(contents);
    std::string out;
    const auto flush = [&] {
        if (std::fwrite(out.data(), 1, out.size(), stdout) != out.size())
            throw FileError("standard output: cannot be written");
        out.clear();
    };
    if (options.json) out += "[";
    for (std::size_t i = 0; i < questions.size(); ++i) {
        job.interruption().check();
        Json answer = answerer.answer(questions[i]);
        if (options.json) {
            Json object{{"question", questions[i].text}};
            object.update(answer);
            out += (i == 0 ? "\n" : ",\n") + object.dump(-1, ' ', false, Json::error_handler_t::replace);
        } else {
            out += as_line(answer) + "\n";
        }
        if (out.size() > 1U << 16) flush();
    }
    if (options.json) out += "\n]\n";
    flush();
    if (std::fflush(stdout) != 0) throw FileError("standard output: cannot be written");
}

}  // namespace

Command add_query_command(CLI::App& program) {
    CLI::App* app = program.add_subcommand("query", "Questions a saved visibility map");
    app->footer(
        "A point is an index or X,Y,Z (the point next to it). Answers come one per line in the order sees, groups, "
        "ray,\n"
        "umbra, --file, --rays. Lines of --file are the options' words: sees A B, groups A:R B:R, ray X,Y,Z DX,DY,DZ,\n"
        "umbra A. Places are in metres with y up, as vmap info shows the box.\n"
        "Example: vmap query room.vmap --sees 12 0.5,0,0.2 --ray 0,1,0 0,-1,0 --umbra 12");
    auto options = std::make_shared<QueryOptions>();
    app->add_option("FILE", options->map, "A .vmap file")->required();
    app->add_option("--sees", options->sees, "Is one point visible from another? May repeat")
        ->type_size(2)
        ->allow_extra_args(false)
        ->type_name("A B");
    app->add_option("--groups", options->groups, "What do the points around one place see of those around another?")
        ->type_size(2)
        ->allow_extra_args(false)
        ->type_name("A:RADIUS B:RADIUS");
    app->add_option("--ray", options->ray, "The first object along a ray: point and distance, or miss")
        ->type_size(2)
        ->allow_extra_args(false)
        ->type_name("X,Y,Z DX,DY,DZ");
    app->add_option("--umbra", options->umbra, "Which lights reach a point: lit, penumbra or umbra")
        ->allow_extra_args(false)
        ->type_name("A");
    app->add_option("--file", options->file, "Questions, one per line; - is standard input")->type_name("FILE");
    app->add_option("--rays", options->rays, "Rays, one per line: six numbers or two vectors")->type_name("FILE");
    app->add_flag("--json", options->json, "Answers as one JSON array");
    return {app, [options](Job& job) { run_query(*options, job); }};
}

}  // namespace vmap
