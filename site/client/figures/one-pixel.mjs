export default async function mount() {}
