// SPDX-License-Identifier: GPL-3.0-or-later
#include "query_text.h"

#include "parse_values.h"

#include <vmap/error.h>
#include <vmap/printable.h>

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

namespace vmap {
namespace {

PointSpec parse_point(std::string_view where, std::string_view text) {
    PointSpec point;
    if (const std::size_t colon = text.find(':'); colon != std::string_view::npos) {
        point.radius = parse_numbers(where, text.substr(colon + 1), 1, 1)[0];
        if (*point.radius < 0) throw UsageError(fmt::format("{}: radius {} is negative", where, *point.radius));
        text = text.substr(0, colon);
    }
    if (text.find(',') != std::string_view::npos) {
        point.where = parse_vector(where, text);
        return point;
    }
    std::uint32_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error != std::errc() || end != text.data() + text.size())
        throw UsageError(fmt::format("{}: '{}' is no point; expected an index or X,Y,Z", where, text));
    point.where = index;
    return point;
}

/// A ray is two vectors or six numbers.
void parse_ray(std::string_view where, const std::vector<std::string>& words, Question& question) {
    if (words.size() == 7) {
        std::vector<double> numbers;
        for (std::size_t i = 1; i < words.size(); ++i) numbers.push_back(parse_numbers(where, words[i], 1, 1)[0]);
        question.from = {numbers[0], numbers[1], numbers[2]};
        question.direction = {numbers[3], numbers[4], numbers[5]};
    } else if (words.size() == 3) {
        question.from = parse_vector(where, words[1]);
        question.direction = parse_vector(where, words[2]);
    } else {
        throw UsageError(fmt::format("{}: expected ray X,Y,Z DX,DY,DZ", where));
    }
    if (!(question.direction.length() > 0)) throw UsageError(fmt::format("{}: a ray needs a direction", where));
}

void parse_points(std::string_view where, const std::vector<std::string>& words, std::size_t count, bool with_radius,
                  Question& question) {
    if (words.size() != count + 1)
        throw UsageError(fmt::format("{}: {} points after {}; expected {}", where, words.size() - 1, words[0], count));
    for (std::size_t i = 1; i < words.size(); ++i) {
        const PointSpec point = parse_point(where, words[i]);
        if (point.radius.has_value() && !with_radius)
            throw UsageError(fmt::format("{}: a radius after {}; expected a point", where, words[0]));
        question.points.push_back(point);
    }
}

}  // namespace

Question parse_question(std::string_view where, const std::vector<std::string>& words) {
    static const std::map<std::string, QuestionKind> kinds{{"sees", QuestionKind::sees},
                                                           {"groups", QuestionKind::groups},
                                                           {"ray", QuestionKind::ray},
                                                           {"umbra", QuestionKind::umbra}};
    const auto kind = words.empty() ? kinds.end() : kinds.find(words[0]);
    if (kind == kinds.end())
        throw UsageError(fmt::format("{}: '{}' is no question; expected sees, groups, ray or umbra", where,
                                     words.empty() ? "" : printable(words[0])));
    Question question;
    question.kind = kind->second;
    for (const std::string& word : words) {
        if (!question.text.empty()) question.text += ' ';
        question.text += printable(word);
    }
    switch (question.kind) {
        case QuestionKind::sees:
            parse_points(where, words, 2, false, question);
            break;
        case QuestionKind::groups:
            parse_points(where, words, 2, true, question);
            break;
        case QuestionKind::umbra:
            parse_points(where, words, 1, false, question);
            break;
        case QuestionKind::ray:
            parse_ray(where, words, question);
            break;
    }
    return question;
}

std::vector<Question> read_questions(const std::string& file, const std::string& kind) {
    std::ifstream stream;
    if (file != "-") {
        stream.open(file);
        if (!stream) throw FileError(printable(file) + ": cannot be opened");
    }
    std::istream& input = file == "-" ? std::cin : stream;
    std::vector<Question> questions;
    std::string line;
    for (std::size_t number = 1; std::getline(input, line); ++number) {
        std::istringstream parts(line);
        std::vector<std::string> words;
        if (!kind.empty()) words.push_back(kind);
        for (std::string word; parts >> word;) words.push_back(word);
        if (words.size() == (kind.empty() ? 0U : 1U) || line.find_first_not_of(" \t") == line.find('#')) continue;
        try {
            questions.push_back(parse_question(fmt::format("{}:{}", printable(file), number), words));
        } catch (const UsageError& error) {
            throw FileError(error.what());
        }
    }
    if (input.bad()) throw FileError(printable(file) + ": cannot be read");
    return questions;
}

}  // namespace vmap
