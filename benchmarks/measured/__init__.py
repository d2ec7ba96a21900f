"""Published measurements through the same search as the campaigns: what it says about data that nobody here made."""
