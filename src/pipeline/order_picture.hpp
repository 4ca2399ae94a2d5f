#pragma once

/// The picture of one triangle that `order` draws.

#include <thalweg/order/constrained_order.hpp>
#include <thalweg/pipeline/order_points.hpp>

#include <string>

namespace thalweg {

/// Draws the triangle of an answer to `path`: one panel a definition with the vertices that it counts, or, if
/// the triangle is not valid, one panel that shows why. `target` is the file's name in errors; its extension
/// decides the format. Throws: as draw_order_picture.
void draw_answer(const ConstrainedOrder& orders, const TriangleOrders& answer, const std::string& path,
                 const std::string& target);

}  // namespace thalweg
