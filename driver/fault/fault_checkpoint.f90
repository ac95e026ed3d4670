!> Checkpoints of a fault: a header, then arrays over all cells, each process writing and reading
!> its own rows in one file. Any number of processes can go on from it. A file is written whole,
!> under another name, before it takes the place of the one before; a checksum of all its words,
!> which does not depend on their order, tells whether it is intact.
module fault_checkpoint
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use fault_elasticity, only : slab
    use platform, only : rename_file
    use processes, only : team
    implicit none
    private

    public :: read_checkpoint, write_checkpoint

    integer(int64), parameter :: version = int(z'6661756C74000003', int64)   !! "fault", and 3
    integer, parameter :: word = 8          !! bytes
    integer, parameter :: fixed_words = 5   !! version, fingerprint, nx, nz, numbers of the header

contains

    subroutine write_checkpoint(name, together, part, fingerprint, header, columns, done)
        character(len=*), intent(in) :: name
        type(team), intent(in) :: together
        type(slab), intent(in) :: part
        integer(int64), intent(in) :: fingerprint
        real(dp), intent(in) :: header(:)       !! the same on all processes
        real(dp), intent(in) :: columns(:, :)   !! cells of this process
        logical, intent(out) :: done
        integer(int64) :: total, bytes
        integer :: unit, status, i

        total = ieor(together%xor_of(sum_of_cells(part, columns)), sum_of_header(header))
        status = 0
        if (together%rank == 0) then
            open (newunit=unit, file=name // '.new', access='stream', form='unformatted', &
                status='replace', action='write', iostat=status)
            if (status == 0) write (unit, iostat=status) version, fingerprint, &
                int([part%nx, part%nz, size(header)], int64), header
            if (status == 0) write (unit, pos=place_of(part, size(header), size(columns, 2), 0) &
                + 1, iostat=status) total
            close (unit)
        end if
        done = .not. together%any_of(status /= 0)
        if (.not. done) return
        open (newunit=unit, file=name // '.new', access='stream', form='unformatted', &
            status='old', action='readwrite', iostat=status)
        do i = 1, size(columns, 2)
            if (status == 0) write (unit, pos=place_of(part, size(header), i - 1, part%first - 1) &
                + 1, iostat=status) columns(:, i)
        end do
        close (unit)
        done = .not. together%any_of(status /= 0)
        if (together%rank == 0 .and. done) then
            inquire (file=name // '.new', size=bytes)
            done = bytes == place_of(part, size(header), size(columns, 2), 0) + word
            if (done) done = rename_file(name // '.new', name)
        end if
        done = .not. together%any_of(.not. done)
    end subroutine write_checkpoint

    !> Bytes before a row of a column.
    pure integer(int64) function place_of(part, n_header, column, row) result(bytes)
        type(slab), intent(in) :: part
        integer, intent(in) :: n_header, column, row   !! column and row from 0

        bytes = word * (fixed_words + n_header + int(part%nx, int64) * (int(part%nz, int64) &
            * column + row))
    end function place_of

    !> Fills header and columns. `problem` says why they cannot be used.
    subroutine read_checkpoint(name, together, part, fingerprint, header, columns, problem)
        character(len=*), intent(in) :: name
        type(team), intent(in) :: together
        type(slab), intent(in) :: part
        integer(int64), intent(in) :: fingerprint
        real(dp), intent(out) :: header(:)
        real(dp), intent(out) :: columns(:, :)
        character(len=:), allocatable, intent(out) :: problem
        integer(int64) :: first(fixed_words), total, bytes
        integer :: unit, status, i

        problem = ''
        open (newunit=unit, file=name, access='stream', form='unformatted', status='old', &
            action='read', iostat=status)
        if (status /= 0) then
            problem = 'there is no checkpoint ' // name
            return
        end if
        first = 0
        inquire (unit=unit, size=bytes)
        read (unit, iostat=status) first
        if (status /= 0 .or. first(1) /= version) then
            problem = name // ' is no checkpoint of this version'
        else if (first(2) /= fingerprint .or. first(5) /= size(header)) then
            problem = 'the input is not the one that wrote the checkpoint ' // name
        else if (bytes /= place_of(part, size(header), size(columns, 2), 0) + word) then
            problem = name // ' is damaged: it is not as long as it should be'
        end if
        if (len(problem) == 0) then
            read (unit) header
            do i = 1, size(columns, 2)
                if (part%rows > 0) read (unit, pos=place_of(part, size(header), i - 1, &
                    part%first - 1) + 1) columns(:, i)
            end do
            read (unit, pos=place_of(part, size(header), size(columns, 2), 0) + 1) total
        end if
        close (unit)
        if (len(problem) > 0) return
        if (total /= ieor(together%xor_of(sum_of_cells(part, columns)), sum_of_header(header))) then
            problem = name // ' is damaged: its checksum is not that of its numbers'
        end if
    end subroutine read_checkpoint

    !> Exclusive or of all words, each mixed with its place.
    pure integer(int64) function sum_of_cells(part, columns) result(total)
        type(slab), intent(in) :: part
        real(dp), intent(in) :: columns(:, :)
        integer(int64) :: before
        integer :: i, j

        total = 0
        do j = 1, size(columns, 2)
            before = int(part%nx, int64) * (int(part%nz, int64) * (j - 1) + part%first - 1)
            do i = 1, size(columns, 1)
                total = ieor(total, scrambled(transfer(columns(i, j), total), before + i))
            end do
        end do
    end function sum_of_cells

    pure integer(int64) function sum_of_header(header) result(total)
        real(dp), intent(in) :: header(:)
        integer :: i

        total = 0
        do i = 1, size(header)
            total = ieor(total, scrambled(transfer(header(i), total), -int(i, int64)))
        end do
    end function sum_of_header

    !> Bits of a word, turned and mixed by its place.
    pure integer(int64) function scrambled(bits, place) result(mixed)
        integer(int64), intent(in) :: bits, place

        mixed = ieor(bits, ishftc(place, 17))
        mixed = ieor(mixed, shiftl(mixed, 13))
        mixed = ieor(mixed, shiftr(mixed, 7))
        mixed = ieor(mixed, shiftl(mixed, 17))
        mixed = ishftc(mixed, int(modulo(place, 63_int64)))
    end function scrambled

end module fault_checkpoint
