//! The pairs that come with the page. Who made them stands in the footer of `index.html`.

export interface Sample {
  readonly id: string;
  /** Paths beside the page. */
  readonly first: string;
  readonly second: string;
}

export const INTEL_TWO_CARS: Sample = {
  id: 'intel-two-cars',
  first: 'samples/intel-two-cars/first.png',
  second: 'samples/intel-two-cars/second.png',
};
