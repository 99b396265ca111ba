// SPDX-License-Identifier: MIT
#include "shadow/scene/scene.h"

template class std::vector<gn::Light>;
template class std::vector<gn::Camera>;
template class std::vector<gn::CameraPath>;
template class std::vector<gn::Material>;
template class std::vector<gn::Texture>;
template class std::vector<gn::Object>;
