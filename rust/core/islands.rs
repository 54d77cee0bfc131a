//! Which bodies depend on one another: groups of contacts that share bodies which give way.

/// Splits links between bodies into groups that share no body. Kept between steps, so that a warm step
/// allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct Islands {
    /// Of each body, another of its group, nearer to the root; a root is its own.
    parent: Vec<u32>,
    /// Of each root, the number of its group.
    number: Vec<u32>,
    /// Places of the links, group after group.
    order: Vec<u32>,
    /// Where each group ends in `order`.
    ends: Vec<u32>,
}

/// No group yet.
const NONE: u32 = u32::MAX;

impl Islands {
    /// Splits `links`. Bodies for which `ties` is false (static ones, say) do not tie what they touch.
    pub fn split(&mut self, bodies: usize, links: &[[u32; 2]], ties: impl Fn(u32) -> bool) {
        self.parent.resize(bodies, 0);
        self.number.resize(bodies, NONE);
        for body in links.iter().flatten() {
            self.parent[*body as usize] = *body;
            self.number[*body as usize] = NONE;
        }
        for [a, b] in links {
            if ties(*a) && ties(*b) {
                self.unite(*a, *b);
            }
        }
        self.sort(links, &ties);
    }

    /// Forgets all groups.
    pub fn clear(&mut self) {
        self.ends.clear();
    }

    /// Number of groups.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no group.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Places of the links of a group, in the order they were given.
    #[must_use]
    pub fn group(&self, k: usize) -> &[u32] {
        let start = k.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.order[start as usize..self.ends[k] as usize]
    }

    fn root(&mut self, mut body: u32) -> u32 {
        while self.parent[body as usize] != body {
            let above = self.parent[self.parent[body as usize] as usize];
            self.parent[body as usize] = above;
            body = above;
        }
        body
    }

    /// The smaller number becomes the root, so that the outcome depends on the bodies alone.
    fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }

    /// Counting sort of the links by group; groups in the order in which they are first met.
    fn sort(&mut self, links: &[[u32; 2]], ties: &impl Fn(u32) -> bool) {
        self.ends.clear();
        for link in links {
            let group = self.group_of(link, ties);
            if group as usize == self.ends.len() {
                self.ends.push(0);
            }
            self.ends[group as usize] += 1;
        }
        let mut sum = 0;
        for end in &mut self.ends {
            (sum, *end) = (sum + *end, sum);
        }
        self.order.resize(links.len(), 0);
        for (place, link) in links.iter().enumerate() {
            let group = self.group_of(link, ties) as usize;
            self.order[self.ends[group] as usize] = place as u32;
            self.ends[group] += 1;
        }
    }

    fn group_of(&mut self, [a, b]: &[u32; 2], ties: &impl Fn(u32) -> bool) -> u32 {
        let root = self.root(if ties(*a) { *a } else { *b }) as usize;
        if self.number[root] == NONE {
            self.number[root] = self.ends.len() as u32;
        }
        self.number[root]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_only_static_bodies_tie_stays_apart() {
        let mut islands = Islands::default();
        // 0 is static; 1–2–3 touch, 4 and 5 stand alone on the ground.
        let links = [[0, 1], [0, 4], [2, 3], [1, 2], [5, 0]];
        islands.split(6, &links, |body| body != 0);
        let groups: Vec<_> = (0..islands.len()).map(|k| islands.group(k)).collect();
        assert_eq!(groups, [&[0, 2, 3][..], &[1], &[4]]);
    }
}
