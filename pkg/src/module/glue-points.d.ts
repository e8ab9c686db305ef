// The glue of the module of measurements.

import type { Glue } from './core.js';
import type { OnStage } from './glue.js';

export interface PointsGlue extends Glue {
  fitMotions(positions: Float64Array, derivatives: Float64Array, options: unknown, onStage: OnStage): unknown;
}

export const glue: PointsGlue;
