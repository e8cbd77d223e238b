//! The locus that a feed strategy is lent. It looks for feeds at several places in parallel.

use rayon::prelude::*;
use turnpath_core::ring::{RADII_AT_ONCE, least_feeds_at};
use turnpath_core::{CentreSeries, Centres, Locus, Radial, Rates, Result, Series, SurfaceModel};

use crate::order::one_at_a_time;

/// A thread looks for feeds at a multiple of so many places. With fewer, threads would wait for each other
/// longer than they look.
const PLACES: usize = 64;

/// A locus for the time of planning a law.
pub struct PlanningLocus<'a>(pub &'a dyn Locus);

impl Locus for PlanningLocus<'_> {
    fn surface(&self) -> &dyn SurfaceModel {
        self.0.surface()
    }

    fn radial(&self) -> Radial {
        self.0.radial()
    }

    fn centre(&self, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        self.0.centre(theta, rho, out)
    }

    fn series(&self, theta: &[Series], rho: &[Series], out: CentreSeries<'_>) -> Result<()> {
        self.0.series(theta, rho, out)
    }

    fn rates(&self, theta: &[f64], rho: &[f64], out: Rates<'_>) -> Result<()> {
        self.0.rates(theta, rho, out)
    }

    fn residual_feed(
        &self,
        residual: f64,
        radial: Radial,
        theta: &[f64],
        rho: &[f64],
        feed: &mut [f64],
    ) -> Result<()> {
        let of_each_thread = theta.len().div_ceil(rayon::current_num_threads());
        let places = of_each_thread.next_multiple_of(PLACES).max(PLACES);
        // Slices of unequal length go to the locus as they are.
        let same_lengths = [rho.len(), feed.len()] == [theta.len(); 2];
        if theta.len() <= places || !same_lengths {
            return self.0.residual_feed(residual, radial, theta, rho, feed);
        }
        let parts = theta.par_chunks(places).zip(rho.par_chunks(places));
        let found = parts
            .zip(feed.par_chunks_mut(places))
            .map(|((theta, rho), feed)| self.0.residual_feed(residual, radial, theta, rho, feed));
        one_at_a_time(found).map(|_: Vec<()>| ())
    }

    fn least_residual_feeds(
        &self,
        residual: f64,
        rho: &[f64],
        least: &mut [f64],
    ) -> Option<Result<()>> {
        let of_each_thread = rho.len().div_ceil(rayon::current_num_threads());
        let groups = rho.par_chunks(of_each_thread.clamp(1, RADII_AT_ONCE));
        let found = groups.map(|radii| least_feeds_at(self.0, residual, radii));
        let found = one_at_a_time(found).map(|found| found.concat());
        Some(found.map(|found| least.copy_from_slice(&found)))
    }
}

#[cfg(test)]
mod tests {
    use turnpath_core::{Scalar, StrategyError, Surface};

    use super::*;

    struct Flat;

    impl Surface for Flat {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, _: S) -> S {
            x * 0.0
        }
    }

    /// A locus that knows its feeds alone. They have no value beyond 5 mm.
    struct Feeds;

    impl Locus for Feeds {
        fn surface(&self) -> &dyn SurfaceModel {
            &Flat
        }

        fn radial(&self) -> Radial {
            Radial::Contact
        }

        fn centre(&self, _: &[f64], _: &[f64], _: Centres<'_>) -> Result<()> {
            Err(StrategyError::failed("no centres"))
        }

        fn series(&self, _: &[Series], _: &[Series], _: CentreSeries<'_>) -> Result<()> {
            Err(StrategyError::failed("no series"))
        }

        fn rates(&self, _: &[f64], _: &[f64], _: Rates<'_>) -> Result<()> {
            Err(StrategyError::failed("no rates"))
        }

        fn residual_feed(
            &self,
            residual: f64,
            _: Radial,
            theta: &[f64],
            rho: &[f64],
            feed: &mut [f64],
        ) -> Result<()> {
            for ((feed, theta), rho) in feed.iter_mut().zip(theta).zip(rho) {
                let waves = 2.0 + Scalar::cos(3.0 * theta - rho);
                *feed = if *rho > 5.0 {
                    f64::NAN
                } else {
                    residual * waves
                };
            }
            Ok(())
        }
    }

    fn in_parallel(radii: &[f64]) -> Option<Result<Vec<f64>>> {
        let mut least = vec![0.0; radii.len()];
        let answer = PlanningLocus(&Feeds).least_residual_feeds(1e-3, radii, &mut least)?;
        Some(answer.map(|()| least))
    }

    #[test]
    fn the_feeds_in_parallel_are_those_of_one_radius_after_the_other() {
        let radii: Vec<f64> = (0..500).map(|i| 0.01 * f64::from(i)).collect();
        let alone = |rho: &f64| least_feeds_at(&Feeds, 1e-3, &[*rho]).unwrap();
        let alone: Vec<f64> = radii.iter().flat_map(alone).collect();
        assert_eq!(in_parallel(&radii).unwrap().unwrap(), alone);
        assert!(alone.iter().all(|feed| (feed - 1e-3).abs() < 1e-9));
    }

    #[test]
    fn the_feeds_of_many_places_in_parallel_are_those_of_the_locus() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build();
        pool.unwrap().install(|| {
            for count in [0, 1, 64, 65, 129, 500] {
                let rho: Vec<f64> = (0..count).map(|i| 0.01 * f64::from(i)).collect();
                let theta: Vec<f64> = rho.iter().map(|rho| 7.0 * rho).collect();
                let [mut found, mut alone] = [(); 2].map(|()| vec![f64::NAN; rho.len()]);
                let feed = |locus: &dyn Locus, feed: &mut [f64]| {
                    locus.residual_feed(1e-3, Radial::Contact, &theta, &rho, feed)
                };
                feed(&PlanningLocus(&Feeds), &mut found).unwrap();
                feed(&Feeds, &mut alone).unwrap();
                assert_eq!(found, alone, "{count}");
            }
        });
    }

    #[test]
    fn the_error_is_that_of_the_first_radius_without_a_feed() {
        let radii: Vec<f64> = (0..100).map(|i| 0.1 * f64::from(i)).collect();
        let error = in_parallel(&radii).unwrap().unwrap_err();
        assert!(error.to_string().contains("x = 5.1"), "{error}");
    }
}
