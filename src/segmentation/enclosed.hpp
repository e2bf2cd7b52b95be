#pragma once

#include "gfp/cloud/organized_cloud.hpp"
#include "segmentation/components.hpp"
#include "segmentation/pixel_classes.hpp"

namespace gfp {

/// The floor of a bowl, plate or tray may lie within the support's noise band. Pixels on the support that the object's own
/// pixels (and missing readings) cut off from the rest, and that lie a little higher than the support, are the object's: they
/// are put into `pixels` (kept ascending). What is seen through a handle lies on the support and stays with it.
void take_enclosed(const OrganizedCloud& cloud, const std::vector<std::uint8_t>& classes, const FlatSurface& support, PixelList& pixels);

}  // namespace gfp
