// Traversals whose rays do not wait for each other.

fn group_any(mine: bool) -> bool {
    return mine;
}
