//! Collective messages: to the root, from the root, and between any ranks.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::owners::Owners;
use super::{Comm, ROOT};
use crate::bytes::Reals;

/// Most values gathered or scattered at once.
const AT_ONCE: usize = 4096;

/// Routes of lists that begin or end at a rank, grouped by the two ranks.
#[derive(Debug, Default)]
pub struct Routes {
    bundles: Vec<((usize, usize), Vec<usize>)>,
}

impl Routes {
    /// The routes that begin or end at rank `me` among `all`, each from one rank to another. Both ranks of a route must
    /// pass all routes between them in the same order.
    pub fn new(me: usize, all: impl IntoIterator<Item = (usize, usize)>) -> Self {
        let mut bundles: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
        for (i, route) in all.into_iter().enumerate() {
            if route.0 == me || route.1 == me {
                bundles.entry(route).or_default().push(i);
            }
        }
        Self {
            bundles: bundles.into_iter().collect(),
        }
    }
}

impl Comm {
    /// Sends one value for each of `owners` to the root, which receives them in their order, whichever rank owns what;
    /// the values of a rank travel together. Collective.
    ///
    /// `make(i)` is called on the owner of `i`, `take(i, value)` on the root.
    pub fn gather<O: Owners + ?Sized, T: Serialize + DeserializeOwned>(
        &self,
        owners: &O,
        mut make: impl FnMut(O::Of) -> T,
        mut take: impl FnMut(O::Of, T),
    ) {
        for bundles in bundles(owners.ranks()) {
            let mut arrived = BTreeMap::new();
            self.route_bundles(
                bundles,
                |owner| (owner, ROOT),
                &mut make,
                |i, value| {
                    arrived.insert(i, value);
                },
            );
            for (i, value) in arrived {
                take(i.into(), value);
            }
        }
    }

    /// The values that [`gather`](Self::gather) sends to the root, in their order; empty on the other ranks.
    /// Collective.
    pub fn gathered<O: Owners + ?Sized, T: Serialize + DeserializeOwned>(
        &self,
        owners: &O,
        make: impl FnMut(O::Of) -> T,
    ) -> Vec<T> {
        let mut all = Vec::new();
        self.gather(owners, make, |_, value| all.push(value));
        all
    }

    /// The values that [`scatter`](Self::scatter) sends to this rank, by their number. Collective.
    pub fn scattered<O: Owners + ?Sized, T: Serialize + DeserializeOwned>(
        &self,
        owners: &O,
        make: impl FnMut(O::Of) -> T,
    ) -> BTreeMap<O::Of, T> {
        let mut own = BTreeMap::new();
        self.scatter(owners, make, |i, value| {
            own.insert(i, value);
        });
        own
    }

    /// Sends one value of the root to each of `owners`, in their order; the values for a rank travel together.
    /// Collective.
    ///
    /// `make(i)` is called on the root, `take(i, value)` on the owner of `i`.
    pub fn scatter<O: Owners + ?Sized, T: Serialize + DeserializeOwned>(
        &self,
        owners: &O,
        mut make: impl FnMut(O::Of) -> T,
        mut take: impl FnMut(O::Of, T),
    ) {
        for bundles in bundles(owners.ranks()) {
            self.route_bundles(
                bundles,
                |owner| (ROOT, owner),
                &mut make,
                |i, value| {
                    take(i.into(), value);
                },
            );
        }
    }

    /// Sends the values of every bundle, which belongs to the rank before it, along its `route` in one message.
    /// Collective.
    fn route_bundles<I: From<usize>, T: Serialize + DeserializeOwned>(
        &self,
        bundles: BTreeMap<usize, Vec<usize>>,
        route: impl Fn(usize) -> (usize, usize),
        make: &mut impl FnMut(I) -> T,
        mut take: impl FnMut(usize, T),
    ) {
        let routes: Vec<(usize, usize)> = bundles.keys().copied().map(route).collect();
        let bundles: Vec<Vec<usize>> = bundles.into_values().collect();
        self.route(
            routes,
            |k| {
                let made = bundles[k].iter().map(|&i| make(i.into()));
                made.collect::<Vec<T>>()
            },
            |k, values| {
                let all = bundles[k].iter().copied().zip(values);
                all.for_each(|(i, value)| take(i, value));
            },
        );
    }

    /// Sends a value along each of `routes`, from one rank to another, in their order. Collective.
    ///
    /// `make(i)` is called where route `i` begins, `take(i, value)` where it ends.
    pub fn route<T: Serialize + DeserializeOwned>(
        &self,
        routes: impl IntoIterator<Item = (usize, usize)>,
        mut make: impl FnMut(usize) -> T,
        mut take: impl FnMut(usize, T),
    ) {
        for (i, (from, to)) in routes.into_iter().enumerate() {
            match (from == self.rank(), to == self.rank()) {
                (true, true) => take(i, make(i)),
                (true, false) => self.send(to, &make(i)),
                (false, true) => take(i, self.receive(from)),
                (false, false) => {}
            }
        }
    }

    /// Sends a list along each of `routes`, with a single message between any two ranks; returns the lists that end
    /// here, by the number of their route. Collective.
    ///
    /// `make(i)` is called where route `i` begins.
    pub fn route_lists(
        &self,
        routes: &Routes,
        mut make: impl FnMut(usize) -> Vec<f64>,
    ) -> BTreeMap<usize, Vec<f64>> {
        let bundles = &routes.bundles;
        let mut arrived = BTreeMap::new();
        self.route(
            bundles.iter().map(|(route, _)| *route),
            |b| -> Vec<Reals> { bundles[b].1.iter().map(|&i| Reals(make(i))).collect() },
            |b, lists| arrived.extend(bundles[b].1.iter().copied().zip(lists)),
        );
        let lists = arrived.into_iter().map(|(i, Reals(list))| (i, list));
        lists.collect()
    }

    /// Sends `parts[r]` to every rank r; returns the received parts in the order of ranks. Collective.
    pub fn exchange<T: Serialize + DeserializeOwned + Default>(&self, mut parts: Vec<T>) -> Vec<T> {
        let (me, ranks) = (self.rank(), self.size());
        let mut arrived: Vec<T> = (0..ranks).map(|_| T::default()).collect();
        // In every round the ranks exchange in disjoint pairs, so that none waits for a third.
        for round in 0..ranks.next_power_of_two() {
            let other = me ^ round;
            if other >= ranks {
                continue;
            }
            let part = std::mem::take(&mut parts[other]);
            arrived[other] = match me.cmp(&other) {
                Ordering::Equal => part,
                Ordering::Less => {
                    self.send(other, &part);
                    self.receive(other)
                }
                Ordering::Greater => {
                    let arrived = self.receive(other);
                    self.send(other, &part);
                    arrived
                }
            };
        }
        arrived
    }

    /// Sends the value of every rank to the root, which gets them in the order of ranks; empty on the other ranks.
    /// Collective.
    pub fn collect<T: Serialize + DeserializeOwned + Clone>(&self, value: &T) -> Vec<T> {
        let ranks: Vec<usize> = (0..self.size()).collect();
        self.gathered(&ranks, |_| value.clone())
    }

    /// The largest magnitude of all numbers on all ranks. Collective.
    pub fn largest<'a>(&self, own: impl IntoIterator<Item = &'a f64>) -> f64 {
        let own = own.into_iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let mut largest = self.collect(&own).into_iter().fold(0.0, f64::max);
        self.broadcast(&mut largest);
        largest
    }
}

/// The numbers owned by each rank, in consecutive chunks of all numbers.
fn bundles(owners: &[usize]) -> impl Iterator<Item = BTreeMap<usize, Vec<usize>>> + '_ {
    let chunks = owners.chunks(AT_ONCE).enumerate();
    chunks.map(|(chunk, owners)| {
        let mut of_rank: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (i, &owner) in (chunk * AT_ONCE..).zip(owners) {
            of_rank.entry(owner).or_default().push(i);
        }
        of_rank
    })
}
