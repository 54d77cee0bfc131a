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
    /// Where each group ends in `order` while links are counted.
    ends: Vec<u32>,
    /// Where each group begins and ends there.
    spans: Vec<[u32; 2]>,
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

    /// Brings the first `ranked` links into the order of their ranks within each group, before the others, and the groups into the
    /// order of the first links of each.
    pub fn arrange<R: Ord>(&mut self, ranked: usize, rank: impl Fn(u32) -> R) {
        let Self { order, spans, .. } = self;
        let has_rank = |link: &u32| (*link as usize) < ranked;
        for [start, end] in &*spans {
            let group = &mut order[*start as usize..*end as usize];
            let count = group.partition_point(has_rank);
            let group = &mut group[..count];
            if !group.is_sorted_by_key(|link| rank(*link)) {
                group.sort_unstable_by_key(|link| rank(*link));
            }
        }
        let first = |[start, _]: &[u32; 2]| {
            let link = order[*start as usize];
            if has_rank(&link) { Ok(rank(link)) } else { Err(link) }
        };
        spans.sort_by_key(first);
    }

    /// Forgets all groups.
    pub fn clear(&mut self) {
        self.spans.clear();
    }

    /// Makes one group of this many links.
    pub fn unite_all(&mut self, links: usize) {
        self.order.clear();
        self.order.extend(0..links as u32);
        self.spans.clear();
        self.spans.push([0, links as u32]);
    }

    /// Number of groups.
    #[must_use]
    pub fn len(&self) -> usize {
        self.spans.len()
    }

    /// Whether there is no group.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.spans.is_empty()
    }

    /// Places of the links of a group, in the order they were given or brought into.
    #[must_use]
    pub fn group(&self, k: usize) -> &[u32] {
        let [start, end] = self.spans[k];
        &self.order[start as usize..end as usize]
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
        self.spans.clear();
        let mut start = 0;
        for end in &self.ends {
            self.spans.push([start, *end]);
            start = *end;
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

    #[test]
    fn links_follow_their_ranks_and_groups_their_first_links() {
        let mut islands = Islands::default();
        // The last two links have no rank.
        let links = [[1, 2], [3, 4], [2, 5], [3, 6], [7, 8], [1, 5]];
        islands.split(9, &links, |_| true);
        islands.arrange(4, |link| [3, 2, 1, 0][link as usize]);
        let groups: Vec<_> = (0..islands.len()).map(|k| islands.group(k)).collect();
        assert_eq!(groups, [&[3, 1][..], &[2, 0, 5], &[4]]);
    }
}
