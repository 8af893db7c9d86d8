// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_CONVERT_UNKNOWN_FIELDS_H_
#define FLATLIGHT_SERVER_CONVERT_UNKNOWN_FIELDS_H_

#include <google/protobuf/message.h>

#include <string>

#include "core/scene/diagnostic.h"

namespace flatlight {

// Reports what a newer or a wrong sender put into a message or anywhere inside it and this program has no meaning for:
// fields, with their number in place of the name (plane.curves[3].9), and values of enums. `root` names the message
// itself and begins every path; empty: the message's fields begin them.
void ReportUnknownFields(const google::protobuf::Message& message, const std::string& root, Diagnostics& diagnostics);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_CONVERT_UNKNOWN_FIELDS_H_
