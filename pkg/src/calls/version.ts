// The version of package.json and Cargo.toml; a test holds the three together.

export const version: string = '0.1.0';
