// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Irradiance at any place of a surface from lit points.
#pragma once

#include <reference/lit_ply.h>

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <memory>
#include <optional>

namespace vmap::crosscheck {

/// Keeps a reference to the points, which must outlive it.
class LitPoints {
public:
    explicit LitPoints(const reference::LitPly& points);
    ~LitPoints();
    LitPoints(const LitPoints&) = delete;
    LitPoints& operator=(const LitPoints&) = delete;

    /// The plane fitted to irradiance at the nearest points of the same side and nearly the same plane; nothing where
    /// fewer than six are near.
    [[nodiscard]] std::optional<Imath::C3f> irradiance_at(const Imath::V3d& position, const Imath::V3d& normal) const;

    /// Whether no other surface has points within a radius.
    [[nodiscard]] bool is_alone(const Imath::V3d& position, const Imath::V3d& normal, double radius) const;

    [[nodiscard]] double spacing() const { return spacing_; }

private:
    class Tree;
    [[nodiscard]] bool is_alike(std::size_t point, const Imath::V3d& position, const Imath::V3d& normal) const;

    const reference::LitPly& points_;
    double spacing_ = 0;
    std::unique_ptr<Tree> tree_;
};

}  // namespace vmap::crosscheck
