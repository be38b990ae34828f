# The two programs, and the makers of assets
