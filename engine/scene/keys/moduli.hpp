#pragma once

/// @file Elastic moduli, which may be given in two ways: as the law has them, or by young and poisson.

namespace mpmfast {

class Keys;

void describe_bulk_and_shear(Keys& map, double& bulk, double& shear);
void describe_lambda_and_shear(Keys& map, double& lambda, double& shear);

}  // namespace mpmfast
