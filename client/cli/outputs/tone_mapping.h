// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_OUTPUTS_TONE_MAPPING_H_
#define FLATLIGHT_CLIENT_CLI_OUTPUTS_TONE_MAPPING_H_

#include "client/cli/outputs/picture_writer.h"

namespace flatlight {

// A picture of light made into one for a screen: values in [0, 1] with sRGB's curve. The middle of its brightness (the
// geometric mean) becomes a middle grey, and the brightest hundredth turns white softly, with hues kept (Reinhard et
// al. 2002, "Photographic tone reproduction for digital images", equation 4).
Picture ToneMapped(const Picture& picture);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_OUTPUTS_TONE_MAPPING_H_
