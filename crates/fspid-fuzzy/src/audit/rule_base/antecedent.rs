//! Antecedents in a form that can be compared.

use alloc::boxed::Box;
use alloc::format;
use alloc::vec::Vec;

use crate::system::{Antecedent, RuleBlock, SNorm, TNorm};

/// The antecedent with nested conjunctions and disjunctions flattened, their parts in a fixed order
/// and double negations removed, as far as the norms allow.
pub(in crate::audit) fn canonical(antecedent: &Antecedent, block: &RuleBlock) -> Antecedent {
    match antecedent {
        Antecedent::Always | Antecedent::Is(_) => antecedent.clone(),
        Antecedent::Not(part) => match canonical(part, block) {
            Antecedent::Not(inner) => *inner,
            inner => Antecedent::Not(Box::new(inner)),
        },
        // A member of the family is commutative and associative; a formula need not be.
        Antecedent::All(parts) => {
            joined(parts, block, matches!(block.and, TNorm::Kind(_)), Antecedent::All)
        }
        Antecedent::Any(parts) => {
            joined(parts, block, matches!(block.or, SNorm::Kind(_)), Antecedent::Any)
        }
    }
}

fn joined(
    parts: &[Antecedent],
    block: &RuleBlock,
    lawful: bool,
    join: fn(Vec<Antecedent>) -> Antecedent,
) -> Antecedent {
    let mut flat = Vec::new();
    for part in parts.iter().map(|part| canonical(part, block)) {
        match (part, join(Vec::new())) {
            (Antecedent::All(inner), Antecedent::All(_))
            | (Antecedent::Any(inner), Antecedent::Any(_))
                if lawful =>
            {
                flat.extend(inner);
            }
            (part, _) => flat.push(part),
        }
    }
    if lawful {
        flat.sort_by_cached_key(|part| format!("{part:?}"));
    }
    match (flat.len(), flat.pop()) {
        (_, None) => Antecedent::Always,
        (1, Some(only)) => only,
        (_, Some(last)) => {
            flat.push(last);
            join(flat)
        }
    }
}

/// True if `weaker` holds at least as strongly as `stronger` for every t-norm: each of its
/// conjuncts is one of the other's, as often or more.
pub(super) fn implied_by(weaker: &Antecedent, stronger: &Antecedent) -> bool {
    let mut left: Vec<&Antecedent> = conjuncts(stronger).iter().collect();
    conjuncts(weaker).iter().all(|part| {
        let found = left.iter().position(|candidate| *candidate == part);
        found.map(|place| left.swap_remove(place)).is_some()
    })
}

/// The parts that must all hold.
pub(super) fn conjuncts(antecedent: &Antecedent) -> &[Antecedent] {
    match antecedent {
        Antecedent::Always => &[],
        Antecedent::All(parts) => parts,
        single => core::slice::from_ref(single),
    }
}
